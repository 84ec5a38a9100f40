"""Machine code from the disk: the kinds of arguments that it is found by, and calls."""

import contextlib
import io
import json
import math
import os
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
import pytest

from wallkit.kernels import machine_code
from wallkit.kernels.jit import compiled, kernel
from wallkit.kernels.machine_code import file_of, read, write
from wallkit.kernels.signatures import Told, kinds_of, taken, word_formats

RECORD = np.dtype([("a", np.float64), ("b", np.uint32)], align=True)


class Pair(NamedTuple):
    left: object
    right: object


ARGUMENTS = [
    3,
    2.5,
    True,
    None,
    np.int16(-3),
    np.uint32(7),
    np.arange(6.0),
    np.arange(6.0)[::2],
    np.zeros((2, 3), dtype=np.int64),
    np.asfortranarray(np.zeros((2, 3))),
    np.zeros(0, dtype=np.uint8),
    np.zeros(3, dtype=RECORD),
    (1, 2.0, (3,)),
    Pair(np.zeros(2), None),
]


@kernel
def handed_over(before, _argument, after):
    return before + after


@pytest.mark.parametrize("argument", ARGUMENTS, ids=lambda argument: type(argument).__name__)
def test_an_argument_takes_as_many_words_as_its_kind_says(argument):
    kinds, words = taken((argument,))
    assert len(word_formats(kinds)) == len(words)
    assert compiled(handed_over)(2, argument, 0.5) == 2.5


def test_an_array_that_cannot_be_written_to_is_of_the_same_kind():
    frozen = np.zeros(3)
    frozen.flags.writeable = False
    assert kinds_of((frozen,)) == kinds_of((np.zeros(3),))


@kernel
def looked_up(pair, table, row, scale, flag, none):
    """What each kind of argument comes to: taken apart, read and written."""
    found = pair.left[1] * scale + table[0, 1] + row[2].a
    pair.left[0] = found
    return found, len(table), flag and none is None


def test_arguments_of_each_kind_arrive_and_results_come_back():
    def arguments():
        table = np.arange(12.0).reshape(3, 4)[:, ::2].T[:, 1:]  # neither C's order nor Fortran's
        row = np.zeros(3, dtype=RECORD).view(np.recarray)
        row["a"] = (1.0, 2.0, 4.0)
        return Pair(np.array([0.0, 3.0]), None), table, row, 2.0, True, None

    plain, machine, told = arguments(), arguments(), arguments()
    expected = looked_up(*plain)
    assert compiled(looked_up)(*machine) == expected
    assert compiled(looked_up)(Told(told[0]), *told[1:]) == expected
    assert plain[0].left[0] == machine[0].left[0] == told[0].left[0]


def test_what_no_kernel_takes_is_refused():
    with pytest.raises(TypeError, match="not a str"):
        compiled(looked_up)("text")


@kernel
def doubled(x):
    return 2 * x


@pytest.mark.parametrize("damage", [lambda told: told[:-40], lambda told: b"", lambda told: b"{}\n" + told])
def test_a_damaged_file_is_compiled_anew(damage, tmp_path, monkeypatch):
    from wallkit.kernels.jit import MachineCode, own_folder

    monkeypatch.setenv("WALLKIT_CACHE_DIR", str(tmp_path))
    assert MachineCode(doubled)(3) == 6
    file = file_of(own_folder(), doubled, kinds_of((3,)))
    good = file.read_bytes()
    file.write_bytes(damage(good))
    assert read(file) is None
    assert MachineCode(doubled)(3) == 6
    assert read(file) is not None
    assert [path.name for path in file.parent.iterdir()] == [file.name]


def test_machine_code_that_needs_what_nobody_provides_is_compiled_anew(tmp_path, monkeypatch):
    from wallkit.kernels.jit import MachineCode, own_folder

    monkeypatch.setenv("WALLKIT_CACHE_DIR", str(tmp_path))
    assert MachineCode(doubled)(3) == 6
    file = file_of(own_folder(), doubled, kinds_of((3,)))
    code = read(file)
    assert code is not None
    write(file, code._replace(needs=("no_library_has_this_function",)))
    assert read(file) is None
    assert MachineCode(doubled)(3) == 6
    anew = read(file)
    assert anew is not None
    assert anew.needs == ()


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_a_terminal_is_told_once_what_is_waited_for(tmp_path, monkeypatch):
    from wallkit.kernels.jit import MachineCode, cache_folder

    monkeypatch.setenv("WALLKIT_CACHE_DIR", str(tmp_path))
    for stream, told in ((Terminal(), 1), (io.StringIO(), 0)):
        folder = cache_folder()
        monkeypatch.setattr(sys, "stderr", stream)
        for argument in (3, 3.0, 3, True):
            MachineCode(doubled)(argument)
        assert stream.getvalue().count(f"once: they are kept in {folder}") == told
        monkeypatch.setenv("WALLKIT_CACHE_DIR", str(tmp_path / "other"))


NEEDY = """
import sys
from pathlib import Path
from wallkit.kernels.machine_code import Code, read, write
file = Path(sys.argv[1])
write(file, Code("f", None, b"", tuple(sys.argv[2:])))
print(read(file) is not None)
"""


@pytest.mark.parametrize(("name", "found"), [("memcpy", "True"), ("no_such_function", "False")])
def test_code_that_needs_what_the_process_has_not_is_not_read(name, found, tmp_path):
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    arguments = [sys.executable, "-c", NEEDY, str(tmp_path / "needy.code"), "cos", name]
    assert subprocess.run(arguments, env=env, capture_output=True, check=True, text=True).stdout.strip() == found


@kernel
def grown(x):
    return math.expm1(x)


def test_what_machine_code_needs_is_noted(tmp_path, monkeypatch):
    from wallkit.kernels.jit import MachineCode, own_folder

    monkeypatch.setenv("WALLKIT_CACHE_DIR", str(tmp_path))
    assert MachineCode(grown)(3.0) == math.expm1(3.0)
    code = read(file_of(own_folder(), grown, kinds_of((3.0,))))
    assert code is not None
    assert code.needs == ("expm1",)


AGAIN = """
import json, sys
import numpy as np
from wallkit import Balls, Scene, Walls, survey
walls = Walls.from_polylines([[(0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (0.0, 30.0)]])
scene = Scene(walls, Balls(np.full((300, 2), 9.0), np.arange(600.0).reshape(300, 2), radius=1.0))
print(json.dumps([survey(scene, bounces=5).position.tobytes().hex(), "wallkit.kernels.compiler.whole" in sys.modules]))
"""


def test_once_compiled_a_survey_needs_no_compiler(tmp_path):
    path = os.pathsep.join(filter(None, sys.path))
    env = {**os.environ, "WALLKIT_CACHE_DIR": str(tmp_path), "PYTHONPATH": path}
    first, again = (
        json.loads(subprocess.run([sys.executable, "-c", AGAIN], env=env, capture_output=True, check=True).stdout)
        for _ in range(2)
    )
    assert first == [again[0], True]
    assert again[1] is False


def test_threads_that_load_first_at_the_same_time_load_into_one_engine(monkeypatch):
    from llvmlite import binding

    both, made = threading.Barrier(2), []

    def make_slowly(*_arguments):
        with contextlib.suppress(threading.BrokenBarrierError):
            both.wait(0.5)  # until the other thread is here as well, which it must never be
        made.append(object())
        return made[-1]

    monkeypatch.setattr(binding, "create_mcjit_compiler", make_slowly)
    monkeypatch.setattr(machine_code, "_engines", [])
    machine_code._machine()
    with ThreadPoolExecutor(2) as threads:
        asked = [threads.submit(machine_code._engine) for _ in range(2)]
    assert {id(one.result()) for one in asked} == {id(made[0])}
    assert len(made) == 1


COMPILE_AND_NOTE = """
import sys
import wallkit.kernels.jit as jit
from tests.physics.test_machine_code import doubled

really = jit._compile


def compile_and_note(*arguments):
    with open(sys.argv[1], "a") as notes:
        notes.write("compiled\\n")
    return really(*arguments)


jit._compile = compile_and_note
assert jit.MachineCode(doubled)(3) == 6
"""


def test_of_processes_that_want_the_same_kernel_one_compiles(tmp_path):
    path = {"WALLKIT_CACHE_DIR": str(tmp_path / "home"), "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    command = [sys.executable, "-c", COMPILE_AND_NOTE, str(tmp_path / "notes")]
    processes = [subprocess.Popen(command, env={**os.environ, **path}) for _ in range(3)]
    assert [process.wait() for process in processes] == [0, 0, 0]
    assert (tmp_path / "notes").read_text() == "compiled\n"
    assert not [*tmp_path.rglob("*.lock")]
