"""Known answers among arcs: what circle, ellipse and stadium conserve."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from wallkit.accuracy import scenes
from wallkit.accuracy.cases import Verdict, add, case, fly, nothing
from wallkit.geometry.arrays import FloatArray
from wallkit.walls import Walls

SPEED = 50.0
EPS = 2.0**-53


def _circle(radius: float, spread: float) -> Verdict:
    """Every chord of a circle makes the same angle with it; the angular momentum stays."""
    x, y = 10.0 * (1 - radius / 100.0), 20.0 * (1 - radius / 100.0)  # within what the disc leaves free
    run = fly(scenes.circle(100.0), (x, y), (SPEED * math.cos(spread), SPEED * math.sin(spread)), radius, bounces=5000)
    c = run.contacts
    spin = c["x"] * c["vy"] - c["y"] * c["vx"]
    first = x * SPEED * math.sin(spread) - y * SPEED * math.cos(spread)
    # A bounce leaves the spin but for the roundings of place (100) and speed (50), and of the normal: 8 EPS each,
    # growing at worst as their number.
    bound = len(c) * 8 * EPS * 100.0 * SPEED
    error = float(np.abs(spin - first).max()) if len(c) == 5000 else math.inf
    return nothing("x v_y - y v_x", error, bound, "eight roundings a bounce")


for _radius, _spread in ((0.0, 0.3), (0.0, 1.1), (5.0, 0.3), (99.0, 0.3), (0.0, 2.0344439357957027)):
    add(
        f"circle, r = {_radius:g}, aim {_spread:.3g}",
        "arcs",
        "5,000 chords of a circle made of four arcs conserve the angular momentum",
        partial(_circle, _radius, _spread),
    )


def ellipse(a: float, b: float, pieces: int) -> Walls:
    """Make an ellipse as a room of arcs, each through three of its points."""
    turns = -np.arange(2 * pieces) * math.tau / (2 * pieces)
    points = np.stack([a * np.cos(turns), b * np.sin(turns)], axis=1)
    start, middle, end = points[0::2], points[1::2], np.roll(points[0::2], -1, axis=0)
    return scenes.room(start, list(scenes.bulge_through(start, middle, end)))


def _ellipse_invariant(pieces: int) -> tuple[float, float, FloatArray]:
    a, b = 200.0, 120.0
    c = math.sqrt(a * a - b * b)
    contacts = fly(
        ellipse(a, b, pieces), (30.0, 10.0), (SPEED * math.cos(0.7), SPEED * math.sin(0.7)), bounces=200
    ).contacts
    x, y, vx, vy = (contacts[name] for name in ("x", "y", "vx", "vy"))
    product = ((x - c) * vy - y * vx) * ((x + c) * vy - y * vx)
    start = ((30.0 - c) * SPEED * math.sin(0.7) - 10.0 * SPEED * math.cos(0.7)) * (
        (30.0 + c) * SPEED * math.sin(0.7) - 10.0 * SPEED * math.cos(0.7)
    )
    return start, float(np.abs(product - start).max()), product


@case("ellipse as arcs", "the product of the angular momenta about the foci, over 200 bounces")
def ellipse_invariant() -> Verdict:
    """The invariant is as good as the arcs fit: an arc through three points of a curve errs by the third order."""
    pieces = 400
    _, error, _ = _ellipse_invariant(pieces)
    # With s = half the parameter step the normal of the arc differs from the ellipse's by up to |dk/du| s^2 / 3
    # (the arc takes the middle curvature), dk/du <= 3 (a^2 - b^2) b / a^... : bounded here by its largest value
    # over the ellipse, found numerically; a turn d of the normal turns the velocity by 2 d, and the product of
    # two momenta (each at most 2 a SPEED) by 2 d * 2 a SPEED * 2 a SPEED. They add up at worst over all bounces.
    a, b = 200.0, 120.0
    u = np.linspace(0, math.tau, 10_001)
    curvature = a * b / (a**2 * np.sin(u) ** 2 + b**2 * np.cos(u) ** 2) ** 1.5
    arc_rate = float(np.abs(np.gradient(curvature, u)).max()) * a  # times ds/du <= a
    turn = arc_rate * (math.pi / pieces) ** 2
    bound = 200 * 2 * turn * (2 * a * SPEED) ** 2
    return nothing("L1 L2", error, bound, "the arcs' own normal error, twice a bounce")


@case("ellipse, finer arcs", "ten times the arcs: the invariant a hundred times better")
def ellipse_converges() -> Verdict:
    """The normal error falls with the square of the arc's length."""
    coarse, fine = _ellipse_invariant(100)[1], _ellipse_invariant(1000)[1]
    return Verdict("1/100", f"1/{coarse / fine:.3g}", fine / coarse, 1 / 30, "second order, within a factor 3")


@case("stadium stays in", "5,000 bounces of a disc in a stadium: never nearer to the wall than its radius")
def stadium_keeps() -> Verdict:
    """The disc's centre stays in the stadium of radius R - r."""
    contacts = fly(
        scenes.stadium(), (3.0, -7.0), (SPEED * math.cos(0.5), SPEED * math.sin(0.5)), 5.0, bounces=5000
    ).contacts
    across = np.hypot(np.maximum(np.abs(contacts["x"]) - 100.0, 0.0), contacts["y"])
    error = float(np.abs(across - 95.0).max()) if len(contacts) == 5000 else math.inf
    return nothing("95 from the middle line", error, 16 * EPS * 200.0, "each contact is found anew: no growth")


@case("half circle, aimed along its tangent", "a point that runs along a straight into a tangential joint")
def tangential_joint() -> Verdict:
    """Seams between tangential edges give no ghost hits: the chords hug the wall at an angle that stays."""
    slow = 1e-3
    velocity = (SPEED * math.cos(slow), -SPEED * math.sin(slow))
    contacts = fly(scenes.stadium(), (0.0, -99.9), velocity, bounces=2000).contacts
    across = np.hypot(np.maximum(np.abs(contacts["x"]) - 100.0, 0.0), contacts["y"])
    error = float(np.abs(across - 100.0).max()) if len(contacts) == 2000 else math.inf
    return nothing("on the wall", error, 16 * EPS * 200.0, "each contact is found anew: no growth")
