"""Who is compared: the exact simulator, the ways of stepping, and other engines where they are installed.

Each contestant flies one ball and says where it is at given times. Engines are set up as their manuals ask for a
bouncing ball without losses: restitution 1, no friction, no damping, continuous collision where there is one.
"""

from __future__ import annotations

import importlib.util
import math
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.scene.scene import Scene
from wallkit.walls import Walls

Place = tuple[float, float]
MOST_STEPS = 400_000


@dataclass(frozen=True, slots=True)
class Flown:
    """What a contestant gave.

    Attributes:
        position: (m, 2) centre at each time asked for; fewer rows when it was too slow to get there.
        velocity: (2,) at the last of them.
        seconds: of processor time per simulated second (a busy machine does not change it).
    """

    position: FloatArray
    velocity: FloatArray
    seconds: float


@dataclass(frozen=True, slots=True)
class Contestant:
    """One setting of one series.

    Attributes:
        series: such as ``"pymunk"``.
        setting: what is swept, for people: ``"dt 1/60"``.
        value: the same as a number.
        fly: flies the scene's first ball through rising times, ``runs`` times for the least time.
    """

    series: str
    setting: str
    value: float
    fly: Callable[[FloatArray, int], Flown]


def exact(scene: Scene, series: str, setting: str, value: float) -> Contestant:
    """Wrap the exact simulator, compiled; preparing the walls is not timed, as it is not for the others."""

    def fly(times: FloatArray, runs: int) -> Flown:
        from wallkit.simulation.simulate import Flights, simulate

        run = simulate(scene, until=float(times[-1]), mode="compiled")
        position = np.array([run.position(float(t))[0] for t in times])
        least = math.inf
        for _ in range(runs):
            flights = Flights(scene, mode="compiled")
            begin = time.process_time()
            noted = sum(len(piece) for piece in flights.fly(0, math.inf, 20_000))
            if noted == 0:
                break
            least = min(least, (time.process_time() - begin) / flights.final()["time"][0])
        return Flown(position, run.velocity(float(times[-1]))[0], least)

    return Contestant(series, setting, value, fly)


def stepped(scene: Scene, way: Any, dt: float) -> Contestant:
    """Wrap :class:`wallkit.World` in one of its ways."""

    def fly(times: FloatArray, runs: int) -> Flown:
        from wallkit.simulation.world import World

        def start() -> Stepper:
            world = World(scene, way, compile=True)
            return Stepper(lambda: world.step(dt) is None, lambda: (world.position[0], world.velocity[0]))

        return _through(start, dt, times, runs, np.asarray(scene.gravity or (0.0, 0.0)))

    return Contestant(f"step, {way}", f"dt {_fraction(dt)}", dt, fly)


@dataclass(frozen=True, slots=True)
class Stepper:
    """An engine that was set up: ``step`` moves on by its time step, ``state`` gives position and velocity."""

    step: Callable[[], Any]
    state: Callable[[], tuple[Any, Any]]


def _through(
    start: Callable[[], Stepper], dt: float, times: FloatArray, runs: int, pull: FloatArray | None = None
) -> Flown:
    """Step through the times; within a step a ball flies on freely from the step's beginning."""
    counts = np.floor(times / dt).astype(int)
    counts = counts[counts <= MOST_STEPS]
    if not len(counts):
        return Flown(np.empty((0, 2)), np.full(2, math.nan), math.nan)
    least = math.inf
    places: list[FloatArray] = []
    for _ in range(runs):
        engine = start()
        step, places, spent, done = engine.step, [], 0.0, 0
        for index, count in enumerate(counts):
            begin = time.process_time()
            for _ in range(count - done):
                step()
            spent += time.process_time() - begin
            done = int(count)
            position, velocity = (np.array(tuple(pair), dtype=float) for pair in engine.state())
            rest = times[index] - count * dt
            places.append(position + rest * velocity + (0.0 if pull is None else 0.5 * rest * rest * pull))
        least = min(least, spent / (done * dt))
        if spent > 0.5:  # slow ones are timed well enough by one run
            break
    return Flown(np.array(places), velocity, least)


def pymunk_engine(scene: Scene, dt: float) -> Contestant:
    """Wrap pymunk (Chipmunk): segments of no thickness that know their neighbours, elasticity 1."""

    def start() -> Stepper:
        import pymunk

        space = pymunk.Space()
        position, velocity, radius = _ball(scene)
        for points, closed in _polylines(scene.walls):
            for before, a, b, after in _with_neighbours(points, closed):
                line = pymunk.Segment(space.static_body, a, b, 0.0)
                line.set_neighbors(before, after)  # its manual's way against ghost hits at joints
                line.elasticity, line.friction = 1.0, 0.0
                space.add(line)
        body = pymunk.Body(1.0, math.inf)
        body.position, body.velocity = tuple(position), tuple(velocity)
        disc = pymunk.Circle(body, radius)
        disc.elasticity, disc.friction = 1.0, 0.0
        space.add(body, disc)
        return Stepper(lambda: space.step(dt), lambda: (body.position, body.velocity))

    return Contestant("pymunk", f"dt {_fraction(dt)}", dt, lambda times, runs: _through(start, dt, times, runs))


def box2d_engine(scene: Scene, dt: float) -> Contestant:
    """Wrap Box2D 2.3: chains, a bullet (continuous collision), restitution 1, 8 and 3 iterations."""

    def start() -> Stepper:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # its wrapper warns when loaded, and crashes where warnings are errors
            import Box2D

        position, velocity, radius = _ball(scene)
        world = Box2D.b2World(gravity=(0, 0), doSleep=False)
        ground = world.CreateStaticBody()
        for points, closed in _polylines(scene.walls):
            # chains know their neighbours, its manual's way against ghost hits at joints
            shape = {"vertices_loop": points} if closed else {"vertices_chain": points}
            chain = Box2D.b2ChainShape(**shape) if len(points) > 2 else Box2D.b2EdgeShape(vertices=points)
            ground.CreateFixture(shape=chain, friction=0.0, restitution=1.0)
        body = world.CreateDynamicBody(position=tuple(position), bullet=True, fixedRotation=True, linearDamping=0.0)
        body.CreateCircleFixture(radius=radius, density=1.0, friction=0.0, restitution=1.0)
        body.linearVelocity = tuple(velocity)
        return Stepper(lambda: world.Step(dt, 8, 3), lambda: (body.position, body.linearVelocity))

    return Contestant("Box2D 2.3", f"dt {_fraction(dt)}", dt, lambda times, runs: _through(start, dt, times, runs))


def billiards_engine(scene: Scene) -> Contestant | None:
    """Wrap ``billiards``, exact too, which knows endless walls and discs: convex rooms with round pillars only."""
    obstacles = _endless(scene.walls)
    if obstacles is None:
        return None

    def fly(times: FloatArray, runs: int) -> Flown:
        import billiards

        position, velocity, radius = _ball(scene)
        least, places = math.inf, np.empty((0, 2))
        for _ in range(runs):
            table = billiards.Billiard(obstacles=obstacles)
            table.add_ball(position, velocity, radius)
            found, spent = [], 0.0
            for moment in times:
                begin = time.process_time()
                table.evolve(float(moment))
                spent += time.process_time() - begin
                found.append(table.balls_position[0].copy())
            least, places = min(least, spent / float(times[-1])), np.array(found)
        return Flown(places, table.balls_velocity[0].copy(), least)

    return Contestant("billiards", "event-driven", 0.0, fly)


def _endless(walls: Walls) -> list[Any] | None:
    """The walls as endless lines and discs, or None where they are not such."""
    import billiards.obstacles as shapes

    room = walls[0]
    if np.any(room.bulges) or not room.closed or len(walls) > 2:
        return None
    corners = room.vertices
    sides = np.roll(corners, -1, axis=0) - corners
    turns = sides[:, 0] * np.roll(sides, -1, axis=0)[:, 1] - sides[:, 1] * np.roll(sides, -1, axis=0)[:, 0]
    if not np.all(turns < 0):  # a room is clockwise, inside is to the right
        return None
    found: list[Any] = [
        shapes.InfiniteWall(tuple(a), tuple(b), inside="right")
        for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)
    ]
    if len(walls) == 2:
        pillar = walls[1]
        middle = pillar.vertices.mean(axis=0)
        reach = np.hypot(*(pillar.vertices - middle).T)
        if len(pillar.vertices) != 4 or not np.allclose(pillar.bulges, math.tan(math.pi / 8)):
            return None
        found.append(shapes.Disk(tuple(middle), float(reach[0])))
    return found


def others(lines: Scene, best: Scene, steps: list[float]) -> Iterator[Contestant]:
    """Give the other engines that are installed and can do this scene.

    Most know no points; and what acts beside walls (gravity, losses) they model each in a way of its own.
    """
    if lines.gravity is not None or not lossless(lines):
        return
    disc = _ball(lines)[2] > 0
    for name, make in (("pymunk", pymunk_engine), ("Box2D", box2d_engine)):
        if disc and importlib.util.find_spec(name) is not None:
            yield from (make(lines, dt) for dt in steps)
    if importlib.util.find_spec("billiards") is not None:
        contestant = billiards_engine(best)
        if contestant is not None:
            yield contestant


def lossless(scene: Scene) -> bool:
    """No wall takes anything from the speed."""
    return all(wall.restitution == 1 and wall.tangential_restitution == 1 for wall in scene.walls.materials)


def _ball(scene: Scene) -> tuple[FloatArray, FloatArray, float]:
    balls = scene.balls
    position = np.atleast_2d(np.asarray(balls.position, dtype=np.float64))[0]
    velocity = np.atleast_2d(np.asarray(balls.velocity, dtype=np.float64))[0]
    return position, velocity, float(np.atleast_1d(np.asarray(balls.radius, dtype=np.float64))[0])


def _polylines(walls: Walls) -> list[tuple[list[Place], bool]]:
    return [([(float(x), float(y)) for x, y in wall.vertices], wall.closed) for wall in walls]


def _with_neighbours(points: list[Place], closed: bool) -> Iterator[tuple[Place, Place, Place, Place]]:
    """Each edge with the points before and after it; at the ends of an open wall its own."""
    count = len(points)
    for k in range(count if closed else count - 1):
        before = points[k - 1] if closed or k else points[k]
        after = points[(k + 2) % count] if closed or k + 2 < count else points[k + 1]
        yield before, points[k], points[(k + 1) % count], after


def _fraction(dt: float) -> str:
    return f"1/{round(1 / dt)}" if dt < 1 else f"{dt:g}"
