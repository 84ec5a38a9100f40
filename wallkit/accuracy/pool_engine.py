"""pooltool as a contestant: a pool table, event-driven, with its friction brought down to next to nothing."""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np

from wallkit.accuracy.engines import Contestant, Flown
from wallkit.geometry.arrays import FloatArray
from wallkit.scene.scene import Scene

FRICTIONS = (1e-2, 1e-4, 1e-6, 1e-8)
METRE = 100.0  # units of the scene in one of pooltool's


def pooltool_engines(scene: Scene) -> Iterator[Contestant]:
    """Wrap ``pooltool``, which knows equal balls on a rectangular table: nothing for other scenes.

    Its balls slide and roll on cloth. A friction of 0 is an error in its solver of quartics, so the friction, of
    sliding and of rolling, is swept down to where its own correction of 1e-9 m a contact is what is left. Balls meet
    elastically and without friction, as by its default; cushions give back what they get (its model "unrealistic",
    without loss). Quartics are solved numerically: its default solver loses contacts at such frictions.
    """
    if _table(scene) is not None:
        yield from (_pooltool(scene, friction) for friction in FRICTIONS)


def _pooltool(scene: Scene, friction: float) -> Contestant:
    def fly(times: FloatArray, runs: int) -> Flown:
        engine, least = _engine(), math.inf
        import pooltool
        from pooltool.ptmath.roots.quartic import QuarticSolver

        flown: Any = None
        for run in range(runs + 1):
            table = _system(scene, friction)
            begin = time.process_time()
            flown = pooltool.simulate(
                table, engine, inplace=True, t_final=float(times[-1]), quartic_solver=QuarticSolver.NUMERIC
            )
            if run > 0:  # the first one compiles
                least = min(least, (time.process_time() - begin) / float(times[-1]))
        histories = [ball.history.states for ball in flown.balls.values()]
        states = np.array([[_state(history, float(moment)) for history in histories] for moment in times])
        return Flown(states[:, :, 0], states[-1, :, 1], least)

    return Contestant("pooltool", f"friction {friction:.0e}", friction, fly)


def _table(scene: Scene) -> tuple[float, float] | None:
    """Length (along y) and width of a rectangle from the origin with equal balls in it; None for other scenes."""
    low_x, low_y, high_x, high_y = scene.walls.box()
    corners = {(x, y) for x in (low_x, high_x) for y in (low_y, high_y)}
    rectangle = len(scene.walls) == 1 and len(scene.walls.vertices) == 4 and scene.walls[0].closed
    if not rectangle or scene.walls.has_arcs or {(x, y) for x, y in scene.walls.vertices.tolist()} != corners:
        return None
    equal = all(len(np.unique(column)) == 1 for column in (scene.balls.radius, scene.balls.mass))
    return (high_y, high_x) if equal and (low_x, low_y) == (0.0, 0.0) else None


def _engine() -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what it loads to draw with warns
        from pooltool.physics.engine import PhysicsEngine
    from pooltool.physics.resolve.ball_cushion import BallCCushionModel, BallLCushionModel
    from pooltool.physics.resolve.resolver import Resolver, ResolverConfig

    mirrors = ResolverConfig.default()
    mirrors.ball_linear_cushion = BallLCushionModel.UNREALISTIC
    mirrors.ball_circular_cushion = BallCCushionModel.UNREALISTIC
    mirrors.ball_linear_cushion_params = mirrors.ball_circular_cushion_params = {"restitution": False}
    return PhysicsEngine(resolver=Resolver.from_config(mirrors))


def _system(scene: Scene, friction: float) -> Any:
    import pooltool
    from pooltool.objects.table.specs import BilliardTableSpecs

    size = _table(scene)
    assert size is not None
    table = pooltool.Table.from_table_specs(BilliardTableSpecs(l=size[0] / METRE, w=size[1] / METRE))
    balls, radius = {}, float(scene.balls.radius[0]) / METRE
    for number, (place, velocity) in enumerate(zip(scene.balls.position, scene.balls.velocity, strict=True)):
        ball = pooltool.Ball.create(
            str(number), xy=(place / METRE).tolist(), R=radius, u_s=friction, u_r=friction, u_sp_proportionality=0.0
        )
        ball.state.rvw[1, :2] = velocity / METRE
        ball.state.s = pooltool.constants.sliding if velocity.any() else pooltool.constants.stationary
        balls[str(number)] = ball
    return pooltool.System(cue=pooltool.Cue(cue_ball_id="0"), table=table, balls=balls)


def _state(history: list[Any], moment: float) -> FloatArray:
    """Give (place, velocity) of a ball at a time: it flies on freely from its last event, with next to no friction."""
    last = [state for state in history if state.t <= moment][-1]
    place, velocity = METRE * last.rvw[:2, :2]
    return np.array([place + velocity * (moment - last.t), velocity])
