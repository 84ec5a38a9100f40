"""Fly balls in the samples with interpreted kernels and with each level of a wheel's machine code: the same bits.

Run it with the Python of an environment that has such a wheel. Levels that this processor lacks are left out.
"""

import hashlib
import json
import subprocess
import sys
from dataclasses import replace

import numpy as np

from wallkit import Balls, open_scene, simulate, survey
from wallkit.kernels import shipped_code
from wallkit.scene.samples import samples
from wallkit.simulation.survey_backends import WORTH_A_WAVE, WORTH_LOCKSTEP

INTERPRETED = "interpreted"


def fan(balls: Balls) -> Balls:
    """Give as many balls as a wave and lockstep take, from where the first one is in all directions."""
    angle = np.linspace(0.1, 6.1, max(WORTH_A_WAVE, WORTH_LOCKSTEP))
    velocity = 50.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return Balls(np.tile(balls.position[:1], (len(angle), 1)), velocity, float(balls.radius[0]))


def digests(level: str) -> dict[str, str]:
    """Digests of contacts and, but for interpreted kernels, of surveys' results by sample; of one level alone."""
    found = {}
    if level != INTERPRETED:
        shipped_code.LEVELS = {level: shipped_code.LEVELS[level]}
        assert shipped_code.shipped_folders(), f"no machine code for {level}"
    for sample in samples():
        scene = open_scene(sample.path).scene
        bounces = 3 if scene.meeting else 60
        mode = INTERPRETED if level == INTERPRETED else "compiled"
        found[sample.name] = hashlib.sha256(simulate(scene, bounces=bounces, mode=mode).contacts.tobytes()).hexdigest()
        if level == INTERPRETED:
            continue
        digest = hashlib.sha256()
        totals = survey(scene if scene.meeting else replace(scene, balls=fan(scene.balls)), bounces=3)
        for part in (totals.bounces, totals.position, totals.velocity, totals.time, totals.ending):
            digest.update(part.tobytes())
        found[f"survey of {sample.name}"] = digest.hexdigest()
    assert "wallkit.kernels.compiler.whole" not in sys.modules, "a compiler was asked for"
    return found


def main() -> None:
    """Ask a process for each, and compare."""
    if len(sys.argv) > 1:
        print(json.dumps(digests(sys.argv[1])))
        return
    answers = {}
    for level in (INTERPRETED, *(folder.name for folder in shipped_code.shipped_folders())):
        ran = subprocess.run([sys.executable, __file__, level], check=True, stdout=subprocess.PIPE, text=True)
        answers[level] = json.loads(ran.stdout)
        print(f"{level}: {len(answers[level])} digests")
    for level, found in answers.items():
        for other, others in answers.items():
            differ = [name for name in found.keys() & others.keys() if found[name] != others[name]]
            assert not differ, f"{level} and {other} differ in {differ}"


if __name__ == "__main__":
    main()
