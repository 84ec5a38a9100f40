"""Hold random scenes with contact states against the reference of 40 digits: the state at the end, and the horizon.

    python benchmarks/contact_states.py --scenes 1000 --seed 0
    python benchmarks/contact_states.py --scenes 1000 --seed 0 --with rolling

A scene agrees if place and velocity at its end are those of the reference to 1e-9; else the horizon must say that the
run is not good to that. Printed are all that do neither.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

import wallkit
from wallkit.accuracy.contact_scenes import (
    KINDS,
    contact_scene,
    drag_scene,
    one_sided_scene,
    rolling_scene,
    touching_scene,
)
from wallkit.accuracy.reference_contact import ContactReference
from wallkit.accuracy.sure_digits import PrecisionError

TOLERANCE = 1e-9
SCENES = {"rolling": rolling_scene, "drag": drag_scene, "one-sided": one_sided_scene, "touching": touching_scene}


def judge(seed, scene_of):
    """What becomes of one scene: (kind, verdict, how far off, whether it had contact states)."""
    kind, scene, until = scene_of(seed)
    try:
        run = wallkit.simulate(scene, until=until)
    except wallkit.WallkitError:
        return kind, "refused", 0.0, False
    try:
        changes = ContactReference(scene).run(until)
    except PrecisionError:
        return kind, "given up", 0.0, False
    true, own = changes[-1].row(), run.final[0]
    off = float(np.hypot(*(np.array([own["x"], own["y"]]) - true[1:3])))
    off = max(off, float(np.hypot(*(np.array([own["vx"], own["vy"]]) - true[3:5]))))
    held = any(change.kind == "slide" for change in changes)
    if off <= TOLERANCE:
        return kind, "agrees", off, held
    horizon = run.trusted_until(TOLERANCE)[0]
    return kind, "WRONG" if horizon.whole else f"horizon: {horizon.reason}", off, held


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    asked.add_argument("--scenes", type=int, default=100)
    asked.add_argument("--seed", type=int, default=0)
    asked.add_argument(
        "--with", dest="kind", choices=SCENES, help="rolling friction, drag, one-sided walls, starts in touch"
    )
    asked = asked.parse_args()
    table = {kind: {} for kind in KINDS}
    begin, states, worst = time.process_time(), 0, 0.0
    for seed in range(asked.seed, asked.seed + asked.scenes):
        kind, verdict, off, held = judge(seed, SCENES.get(asked.kind, contact_scene))
        states += held
        table[kind][verdict] = table[kind].get(verdict, 0) + 1
        if verdict == "agrees":
            worst = max(worst, off)
        elif verdict not in ("refused",):
            print(f"{seed} {kind}: {verdict}, off by {off:.1e}", flush=True)
    for kind, counts in table.items():
        print(f"{kind:8s} " + ", ".join(f"{count} {verdict}" for verdict, count in sorted(counts.items())))
    spent = time.process_time() - begin
    print(f"{states} with contact states; where it agrees to {worst:.1e} at worst; {spent:.0f} s")


if __name__ == "__main__":
    main()
