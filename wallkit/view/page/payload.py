"""What travels to the browser: walls and runs as JSON, number columns as little-endian base64.

A column is ``{"type": "f8" | "f4" | "i4" | "u1", "data": base64}``. The same tables serve the page and the replay;
static/motion.js and static/walls.js read them.
"""

from __future__ import annotations

import base64
import json
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from wallkit.geometry.arrays import FloatArray
from wallkit.simulation.energy import lowest, mass_parts
from wallkit.simulation.gliding import guides
from wallkit.simulation.run import Ending, Run, one_a_ball, turns_in
from wallkit.view.frame import walls_box
from wallkit.view.outline import solid_areas
from wallkit.view.picture import material_legend, shades
from wallkit.walls import Walls

Table = dict[str, Any]

FULL_PRECISION_CONTACTS = 100_000
"""Up to so many contacts travel as Float64; beyond it places (from the box's middle), velocities and normals are
Float32, off by at most 6e-8 of the picture's size. Times are always Float64."""

HORIZON_CONTACTS = 5_000
"""So many contacts of a run are looked at for its horizon."""


def column(values: ArrayLike, kind: str) -> dict[str, str]:
    """Pack numbers, flattened row by row: ``kind`` is ``f8``, ``f4``, ``i4`` or ``u1``."""
    packed = np.ascontiguousarray(values, dtype=np.dtype(kind).newbyteorder("<"))
    return {"type": kind, "data": base64.b64encode(packed.tobytes()).decode("ascii")}


def walls_table(walls: Walls, free: FloatArray | None = None, sensors: Walls | None = None) -> Table:
    """Give walls as static/walls.js reads them.

    Args:
        walls: any walls.
        free: (n, 2) places that are not material, such as the balls'; they decide which side of a room is filled.
        sensors: drawn dashed; crossings of them change no flight, and are not in :func:`run_table`.
    """
    shade = shades(walls)
    areas = solid_areas(walls, np.empty((0, 2)) if free is None else free)
    return {
        "vertices": column(walls.vertices, "f8"),
        "offsets": column(walls.offsets, "i4"),
        "closed": column(walls.closed, "u1"),
        "bulges": column(walls.bulges, "f8") if walls.has_arcs else None,
        "two_sided": column([sides == "both" for sides in walls.sides], "u1"),
        "names": list(walls.names),
        "layers": list(walls.layers),
        "areas": [
            {"shade": shade[material], "walls": members, "framed": framed} for material, members, framed in areas
        ],
        "box": walls_box(walls) if len(walls) else (0.0, 0.0, 1.0, 1.0),
        "edges": len(walls.edge_starts),
        "y_axis": walls.y_axis,
        "units": walls.units,
        "legend": [
            {"shade": int(style.removeprefix("material")), "words": words} for style, words in material_legend(walls)
        ],
        "sensors": walls_table(sensors) if sensors is not None and len(sensors) else None,
    }


def run_table(run: Run, *, left_out: str = "", horizon: bool = True) -> Table:
    """Give a run as static/motion.js reads it.

    Args:
        run: what is played.
        left_out: a sentence on what of the run is not in it, for people.
        horizon: say how far a single ball's run can be trusted.
    """
    contacts, final = one_a_ball(run.contacts), run.final
    contacts = contacts[turns_in(contacts)]
    start = starts(run)
    full = len(contacts) <= FULL_PRECISION_CONTACTS
    real = "f8" if full else "f4"
    origin = (0.0, 0.0) if full else _middle(run.scene.walls)
    return {
        "balls": len(final),
        "gravity": list(run.scene.gravity) if run.scene.gravity is not None else None,
        "rolling_friction": run.scene.rolling_friction,
        "drag": run.scene.drag,
        "radius": column(run.scene.balls.radius, "f8"),
        "lowest": column(lowest(run), "f8"),
        **({"mass": column(mass_parts(run), "f8")} if run.scene.meeting else {}),
        "start": {name: column(start[:, index], "f8") for index, name in enumerate(("x", "y", "vx", "vy"))},
        "end": {name: column(final[name], "f8") for name in ("time", "x", "y", "vx", "vy")},
        "ending": [Ending(ending).label for ending in run.ending],
        "duration": duration(run),
        "origin": origin,
        "contacts": {
            "time": column(contacts["time"], "f8"),
            "ball": column(contacts["ball"], "i4"),
            "x": column(contacts["x"] - origin[0], real),
            "y": column(contacts["y"] - origin[1], real),
            "vx": column(contacts["vx"], real),
            "vy": column(contacts["vy"], real),
            "nx": column(contacts["nx"], real),
            "ny": column(contacts["ny"], real),
            "wall": column(contacts["wall"], "i4"),
            "kind": column(contacts["kind"], "u1"),
            **({"bend": column(bend, "f8")} if (bend := guides(run.scene.walls, contacts)).any() else {}),
        },
        "trusted": horizon_table(run) if horizon else None,
        "left_out": left_out,
    }


def horizon_table(run: Run) -> Table | None:
    """Give up to where a single ball's run is good to 1e-6; None for many balls, or where a long run begins too well.

    Of a long run only the beginning is looked at: nearly always trust ends there.
    """
    from wallkit.simulation.horizon import trusted_until

    if len(run.final) != 1 or not len(run.contacts):
        return None
    long = len(run.contacts) > HORIZON_CONTACTS
    horizon = trusted_until(run.scene, run.contacts[:HORIZON_CONTACTS], 0, final=None if long else run.final[0])
    if horizon.whole and long:
        return None
    return {"whole": horizon.whole, "time": horizon.time, "sentence": horizon.sentence()}


def starts(run: Run) -> FloatArray:
    """Give (n, 4) x, y, vx, vy at time 0."""
    balls = run.scene.balls
    return np.hstack([np.asarray(balls.position), np.asarray(balls.velocity)]).astype(np.float64).reshape(-1, 4)


def duration(run: Run) -> float:
    """Give the time at which the last ball's run ended (of one that flew out: its last contact)."""
    times = [*run.final["time"].tolist(), *run.contacts["time"][-1:].tolist()]
    return float(max((time for time in times if np.isfinite(time)), default=0.0))


def _middle(walls: Walls) -> tuple[float, float]:
    x0, y0, x1, y1 = walls.box()
    return (x0 + x1) / 2, (y0 + y1) / 2


def inlined(data: Any) -> str:
    r"""Write JSON that may stand inside HTML: every ``<`` is ``\u003c``, so no name can end a script or begin a tag."""
    text = json.dumps(data, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
