"""Machine code that comes with wheels: found by sources, level and kinds, with the same bits at each level."""

import math
import os
import subprocess
import sys

import numpy as np
import pytest

from wallkit.kernels import machine_code, shipped_code
from wallkit.kernels.jit import MachineCode, kernel, own_folder
from wallkit.kernels.machine_code import file_of, sources
from wallkit.kernels.shipped_code import LEVELS, has_levels, settings_for, shipped_folders
from wallkit.kernels.signatures import kinds_of

pytestmark = pytest.mark.skipif(not has_levels(), reason="machine code is shipped for Linux on x86-64 alone")
BASELINE = "x86-64-v2"


@kernel
def blended(a, b, c, found):
    """What a compiler would fuse, reorder or widen if it were let: products with sums, a long sum, roots, quotients."""
    total = 0.0
    for i in range(len(a)):
        found[i] = a[i] * b[i] + c[i] * a[i] - b[i] * c[i]
        total += a[i] * b[i]
    return total + math.sqrt(abs(found[0])) / (a[1] * a[1] + b[1] * b[1])


def arguments():
    a, b, c = np.random.default_rng(3).normal(size=(3, 1000))
    return a, b, c, np.empty(1000)


COMPILE = """
from tests.physics.test_shipped_code import arguments, blended
from wallkit.kernels.jit import compile_for
from wallkit.kernels.signatures import kinds_of
compile_for(blended, *kinds_of(arguments()))
"""


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The folder that a wheel has, with one kernel at each level."""
    folder = tmp_path_factory.mktemp("wheel")
    for level in LEVELS:
        path = {"WALLKIT_CACHE_DIR": str(folder / level), "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        env = {**os.environ, **path, **settings_for(level)}
        subprocess.run([sys.executable, "-c", COMPILE], env=env, check=True)
        (made,) = (folder / level).glob("kernels-*/*/")
        target = folder / "shipped" / made.parent.name / level
        target.parent.mkdir(parents=True, exist_ok=True)
        made.rename(target)
    return folder / "shipped"


@pytest.fixture
def installed(wheel, tmp_path, monkeypatch):
    """This process as if it ran from that wheel, with an empty home: where its cache would be."""
    for name in machine_code.SETTINGS:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(shipped_code, "SHIPPED", wheel)
    monkeypatch.setattr("wallkit.kernels.jit.shipped_folders", shipped_folders.__wrapped__)
    monkeypatch.setenv("WALLKIT_CACHE_DIR", str(tmp_path / "home"))
    return tmp_path / "home"


def compiled_here(home):
    return [path.name for path in home.rglob("*.code")]


@pytest.mark.parametrize("level", LEVELS)
def test_each_level_gives_the_bits_of_the_interpreted_kernel(level, installed, monkeypatch):
    if not shipped_code._features().issuperset(LEVELS[level].split()):
        pytest.skip(f"this processor is not of {level}")
    monkeypatch.setattr(shipped_code, "LEVELS", {level: LEVELS[level]})
    here, there = arguments(), arguments()
    assert MachineCode(blended)(*here) == blended(*there)
    assert here[3].tobytes() == there[3].tobytes()
    assert compiled_here(installed) == []


@pytest.mark.parametrize(
    ("lacks", "levels"),
    [([], list(LEVELS)), (["avx512f"], ["x86-64-v3", BASELINE]), (["avx2"], [BASELINE]), (["sse4.2"], [])],
)
def test_a_processor_gets_the_levels_of_which_it_has_everything(lacks, levels, installed, monkeypatch):
    everything = {name for needs in LEVELS.values() for name in needs.split()}
    monkeypatch.setattr(shipped_code, "_features", lambda: everything.difference(lacks))
    assert [folder.name for folder in shipped_folders.__wrapped__()] == levels


def test_a_damaged_file_is_not_loaded_but_the_next_level_is_and_then_a_compiler(installed, wheel):
    files = [file_of(folder, blended, kinds_of(arguments())) for folder in shipped_folders.__wrapped__()]
    whole = [file.read_bytes() for file in files]
    try:
        expected = blended(*arguments())
        for number, file in enumerate(files):
            file.write_bytes(whole[number][:-100] + bytes(100))
            assert MachineCode(blended)(*arguments()) == expected
            assert len(compiled_here(installed)) == (number == len(files) - 1)
    finally:
        for file, data in zip(files, whole, strict=True):
            file.write_bytes(data)


def test_code_of_other_sources_or_beside_other_settings_is_not_taken(installed, wheel, monkeypatch):
    assert shipped_folders.__wrapped__()
    monkeypatch.setenv("WALLKIT_CPU_NAME", "haswell")
    assert shipped_folders.__wrapped__() == ()
    monkeypatch.delenv("WALLKIT_CPU_NAME")
    monkeypatch.setattr("wallkit.kernels.machine_code.sources", lambda: "of-another-day")
    assert shipped_folders.__wrapped__() == ()


def test_the_users_cache_serves_what_is_not_shipped(installed):
    a, b, c, found = arguments()
    assert MachineCode(blended)(list(a) and a[::2], b, c, found) is not None
    assert own_folder().parent == installed / f"kernels-{sources()}"
    assert len(compiled_here(installed)) == 1
