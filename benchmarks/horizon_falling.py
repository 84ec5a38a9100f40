"""Hold the horizon under gravity against runs that really depart from the reference of 40 digits.

    python benchmarks/horizon_falling.py --scenes 1000 --seed 0

Random scenes with contact states, narrow gaps, nearly straight arcs and grazing hits. Late is a horizon that calls a
contact good which is off by more than its tolerance, or a whole run whose end is; it is early by the ratio of what
really holds to what it promises.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

import wallkit
from wallkit.accuracy.contact_scenes import HARD, contact_scene, hard_scene
from wallkit.accuracy.reference_contact import ContactReference
from wallkit.accuracy.sure_digits import PrecisionError
from wallkit.simulation.run import ContactKind

TOLERANCES = (1e-6, 1e-9, 1e-12)


def errors(run, changes):
    """How far each bounce is off, from the first; up to where the runs stop, or are seen to be others."""
    told = iter(changes)
    found = []
    later = np.diff(run.contacts["time"], append=np.inf) > 1e-9  # in a corner it slides for no time
    for row, goes_on in zip(run.contacts, later, strict=True):
        if row["kind"] == ContactKind.LEAVE or (row["kind"] == ContactKind.SLIDE and not goes_on):
            continue
        # Bounces lower than rounding are not told: where it slides, the reference has some more of them first.
        kind = "bounce" if row["kind"] <= ContactKind.VERTEX else "slide"
        true = next((change for change in told if change.kind == kind), None)
        slow = row["vx"] ** 2 + row["vy"] ** 2 < 1e-4
        if true is None or (true.wall, true.edge) != (row["wall"], row["edge"]):
            return found if slow else [*found, np.inf]
        if kind == "bounce":
            found.append(float(np.hypot(row["x"] - float(true.position[0]), row["y"] - float(true.position[1]))))
    return found


def judge(seed, late, ratios):
    """Hold one scene against the reference; False where that is not possible."""
    kind, scene, until = hard_scene(seed) if seed % 2 else contact_scene(seed // 2)
    try:
        run = wallkit.simulate(scene, until=until)
        changes = ContactReference(scene).run(until)
        off = np.array(errors(run, changes))
    except (wallkit.WallkitError, PrecisionError):
        return False
    true, own = changes[-1], run.final[0]
    at_end = float(np.hypot(own["x"] - float(true.position[0]), own["y"] - float(true.position[1])))
    for tolerance in TOLERANCES:
        horizon = run.trusted_until(tolerance)[0]
        bad = np.flatnonzero(off > tolerance)
        real = int(bad[0]) if len(bad) else len(off)
        says = f"{seed} {kind}: to {tolerance:g} {horizon.bounces} promised, {real} hold ({horizon.reason})"
        if len(bad) and horizon.bounces > real:
            late[tolerance] += 1
            print(f"late {says}, off by {off[real]:.1e}", flush=True)
        elif horizon.whole and at_end > tolerance:
            late[tolerance] += 1
            print(f"late {says}, its end is off by {at_end:.1e}", flush=True)
        ratios[tolerance].append(1.0 if horizon.whole else real / max(horizon.bounces, 1))
        if ratios[tolerance][-1] > 1.5 and tolerance == TOLERANCES[0]:
            print(f"early {says}", flush=True)
    return True


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    asked.add_argument("--scenes", type=int, default=100)
    asked.add_argument("--seed", type=int, default=0)
    asked = asked.parse_args()
    begin = time.process_time()
    late, ratios = dict.fromkeys(TOLERANCES, 0), {tolerance: [] for tolerance in TOLERANCES}
    runs = sum(judge(seed, late, ratios) for seed in range(asked.seed, asked.seed + asked.scenes))
    for tolerance in TOLERANCES:
        early, ended = np.array(ratios[tolerance]), np.count_nonzero(np.array(ratios[tolerance]) != 1.0)
        print(
            f"to {tolerance:g}: {late[tolerance]} late of {runs}, {np.count_nonzero(early > 1.5)} early by more "
            f"than 1.5, {ended} not told to the bounce, {np.quantile(early, 0.9):.2f} in nine of ten"
        )
    print(f"{time.process_time() - begin:.0f} s; {', '.join(HARD)}")


if __name__ == "__main__":
    main()
