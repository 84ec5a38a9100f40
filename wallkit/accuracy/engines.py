"""Who is compared: the exact simulator, the ways of stepping, and other engines where they are installed.

Each contestant flies the scene's balls, one or (where they meet) many, and says where they are at given times. Engines
are set up as their manuals ask for balls that bounce without losses: restitution 1, no friction, no damping, continuous
collision where there is one.
"""

from __future__ import annotations

import copy
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


@dataclass(frozen=True, slots=True, eq=False)
class Flown:
    """What a contestant gave.

    Attributes:
        position: (m, n, 2) centres at each time asked for; fewer rows when it was too slow to get there.
        velocity: (n, 2) at the last of them.
        seconds: of processor time per simulated second (a busy machine does not change it).
    """

    position: FloatArray
    velocity: FloatArray
    seconds: float


@dataclass(frozen=True, slots=True, eq=False)
class Contestant:
    """One setting of one series.

    Attributes:
        series: such as ``"pymunk"``.
        setting: what is swept, for people: ``"dt 1/60"``.
        value: the same as a number.
        fly: flies the scene's balls through rising times, ``runs`` times for the least time.
    """

    series: str
    setting: str
    value: float
    fly: Callable[[FloatArray, int], Flown]


def exact(scene: Scene, series: str, setting: str, value: float) -> Contestant:
    """Wrap the exact simulator, compiled; preparing the walls is not timed, as it is not for the others."""

    def fly(times: FloatArray, runs: int) -> Flown:
        from wallkit.simulation.simulate import simulate

        run = simulate(scene, until=float(times[-1]), mode="compiled")
        timed = _together if scene.meeting else _alone
        least = min(timed(scene, float(times[-1])) for _ in range(runs))
        return Flown(run.position(times), run.velocity(float(times[-1])), least)

    return Contestant(series, setting, value, fly)


def _alone(scene: Scene, _until: float) -> float:
    """Seconds per simulated second of the first ball, over many bounces, since three of them take no time."""
    from wallkit.simulation.simulate import Flights

    flights = Flights(scene, mode="compiled")
    begin = time.process_time()
    noted = sum(len(piece) for piece in flights.fly(0, math.inf, 20_000))
    return (time.process_time() - begin) / float(flights.final()["time"][0]) if noted else math.inf


def _together(scene: Scene, until: float) -> float:
    """Seconds per simulated second of balls that meet, over the time that the others fly too."""
    from wallkit.simulation.meeting import Meeting
    from wallkit.simulation.simulate import START

    meeting = Meeting(scene, START, mode="compiled")
    begin = time.process_time()
    for _ in meeting.go(until, 2**31, most=1000):
        pass
    return (time.process_time() - begin) / until


def stepped(scene: Scene, way: Any, dt: float) -> Contestant:
    """Wrap :class:`wallkit.World` in one of its ways."""

    def fly(times: FloatArray, runs: int) -> Flown:
        from wallkit.simulation.world import World

        def start() -> Stepper:
            world = World(scene, way, compile=True)
            ahead = (lambda rest: _ahead(world, rest)) if scene.meeting else None
            return Stepper(lambda: world.step(dt) is None, lambda: (world.position, world.velocity), ahead)

        return _through(start, dt, times, runs, np.asarray(scene.gravity or (0.0, 0.0)))

    return Contestant(f"step, {way}", f"dt {_fraction(dt)}", dt, fly)


def _ahead(world: Any, rest: float) -> FloatArray:
    """Positions after a part of a frame, in which balls may meet; the world itself stays where it is."""
    twin = copy.deepcopy(world)
    twin.step(rest)
    position: FloatArray = twin.position
    return position


@dataclass(frozen=True, slots=True, eq=False)
class Stepper:
    """An engine that was set up: ``step`` moves on by its time step, ``state`` gives positions and velocities.

    Where it knows better than free flight, ``ahead`` gives positions after a part of a step.
    """

    step: Callable[[], Any]
    state: Callable[[], tuple[Any, Any]]
    ahead: Callable[[float], FloatArray] | None = None


def _through(
    start: Callable[[], Stepper], dt: float, times: FloatArray, runs: int, pull: FloatArray | None = None
) -> Flown:
    """Step through the times; within a step a ball flies on freely from the step's beginning."""
    counts = np.floor(times / dt).astype(int)
    counts = counts[counts <= MOST_STEPS]
    if not len(counts):
        return Flown(np.empty((0, 1, 2)), np.full((1, 2), math.nan), math.nan)
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
            position, velocity = (np.array(state, dtype=float) for state in engine.state())
            rest = times[index] - count * dt
            free = position + rest * velocity + (0.0 if pull is None else 0.5 * rest * rest * pull)
            places.append(free if engine.ahead is None else engine.ahead(rest))
        least = min(least, spent / (done * dt))
        if spent > 0.5:  # slow ones are timed well enough by one run
            break
    return Flown(np.array(places), velocity, least)


def pymunk_engine(scene: Scene, dt: float) -> Contestant:
    """Wrap pymunk (Chipmunk): segments of no thickness that know their neighbours, elasticity 1."""

    def start() -> Stepper:
        import pymunk

        space = pymunk.Space()
        for points, closed in _polylines(scene.walls):
            for before, a, b, after in _with_neighbours(points, closed):
                line = pymunk.Segment(space.static_body, a, b, 0.0)
                line.set_neighbors(before, after)  # its manual's way against ghost hits at joints
                line.elasticity, line.friction = 1.0, 0.0
                space.add(line)
        bodies = []
        for position, velocity, radius, mass in _balls(scene):
            body = pymunk.Body(mass, math.inf)
            body.position, body.velocity = position, velocity
            disc = pymunk.Circle(body, radius)
            disc.elasticity, disc.friction = 1.0, 0.0
            space.add(body, disc)
            bodies.append(body)
        return Stepper(lambda: space.step(dt), lambda: ([b.position for b in bodies], [b.velocity for b in bodies]))

    return Contestant("pymunk", f"dt {_fraction(dt)}", dt, lambda times, runs: _through(start, dt, times, runs))


def box2d_engine(scene: Scene, dt: float) -> Contestant:
    """Wrap Box2D 2.3: chains, a bullet (continuous collision), restitution 1, 8 and 3 iterations."""

    def start() -> Stepper:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # its wrapper warns when loaded, and crashes where warnings are errors
            import Box2D

        ((position, velocity, radius, _mass),) = _balls(scene)
        world = Box2D.b2World(gravity=(0, 0), doSleep=False)
        ground = world.CreateStaticBody()
        for points, closed in _polylines(scene.walls):
            # chains know their neighbours, its manual's way against ghost hits at joints
            shape = {"vertices_loop": points} if closed else {"vertices_chain": points}
            chain = Box2D.b2ChainShape(**shape) if len(points) > 2 else Box2D.b2EdgeShape(vertices=points)
            ground.CreateFixture(shape=chain, friction=0.0, restitution=1.0)
        body = world.CreateDynamicBody(position=position, bullet=True, fixedRotation=True, linearDamping=0.0)
        body.CreateCircleFixture(radius=radius, density=1.0, friction=0.0, restitution=1.0)
        body.linearVelocity = velocity
        return Stepper(lambda: world.Step(dt, 8, 3), lambda: ([tuple(body.position)], [tuple(body.linearVelocity)]))

    return Contestant("Box2D 2.3", f"dt {_fraction(dt)}", dt, lambda times, runs: _through(start, dt, times, runs))


def billiards_engine(scene: Scene) -> Contestant | None:
    """Wrap ``billiards``, exact too, which knows endless walls and discs: convex rooms with round pillars only."""
    obstacles = _endless(scene.walls)
    if obstacles is None:
        return None

    def fly(times: FloatArray, runs: int) -> Flown:
        import billiards

        least, places = math.inf, np.empty((0, 1, 2))
        for _ in range(runs):
            table = billiards.Billiard(obstacles=obstacles)
            for ball in _balls(scene):
                table.add_ball(*ball)
            found, spent = [], 0.0
            for moment in times:
                begin = time.process_time()
                table.evolve(float(moment))
                spent += time.process_time() - begin
                found.append(table.balls_position.copy())
            least, places = min(least, spent / float(times[-1])), np.array(found)
        return Flown(places, table.balls_velocity.copy(), least)

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
    discs = bool((lines.balls.radius > 0).all())
    if discs and _installed("pymunk"):
        yield from (pymunk_engine(lines, dt) for dt in steps)
    if discs and _installed("Box2D") and not lines.meeting:  # it moves nothing by more than 2 units a step: slow balls
        yield from (box2d_engine(lines, dt) for dt in steps)
    if _installed("billiards") and (contestant := billiards_engine(best)) is not None:
        yield contestant
    if lines.meeting and _installed("pooltool"):
        from wallkit.accuracy.pool_engine import pooltool_engines

        yield from pooltool_engines(lines)


def _installed(name: str) -> bool:
    return importlib.util.find_spec(name) is not None


def lossless(scene: Scene) -> bool:
    """No wall, and no ball, takes anything from the speed."""
    walls = all(wall.restitution == 1 and wall.tangential_restitution == 1 for wall in scene.walls.materials)
    return walls and scene.ball_restitution == 1 and scene.ball_tangential_restitution == 1


def _balls(scene: Scene) -> list[tuple[Place, Place, float, float]]:
    """Position, velocity, radius and mass of each ball, as other engines take them: a point weighs something there."""
    balls = scene.balls
    masses = np.where(balls.mass > 0.0, balls.mass, 1.0)
    columns = (balls.position.tolist(), balls.velocity.tolist(), balls.radius.tolist(), masses.tolist())
    return [((x, y), (vx, vy), radius, mass) for (x, y), (vx, vy), radius, mass in zip(*columns, strict=True)]


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
