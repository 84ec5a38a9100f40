"""First use: kernels are compiled by a process of their own while whoever wants them goes on."""

import json
import os
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from wallkit import Balls, Scene, Walls, aim, simulate, survey
from wallkit.kernels import compile_aside
from wallkit.kernels.compile_aside import at_hand
from wallkit.kernels.jit import NotCompiledError, compile_for, compiled, kernel, never_compiling
from wallkit.kernels.signatures import kinds_of

ROOM = [[(0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (0.0, 30.0)]]


@kernel
def half(x):
    """Halve: a kernel that nothing else calls, so that each test compiles it anew for another type."""
    return x / 2


def in_a_fresh_process(code, cache):
    """Run code in a process with a kernel cache of its own; give what it printed last, as JSON."""
    ran = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "WALLKIT_CACHE_DIR": str(cache), "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(ran.stdout.splitlines()[-1])


ASIDE = """
import json, os
from wallkit.kernels import compile_aside
from wallkit.kernels.jit import compile_for, compiled, never_compiling
from wallkit.kernels.signatures import kinds_of
from tests.physics.test_compile_aside import half
wanted = compile_for, half, *kinds_of((3,))
first = compile_aside.at_hand(*wanted)
process = compile_aside._processes[wanted]
code = None if process is None else process.wait()
with never_compiling():
    value = compiled(half)(3)
print(json.dumps([first, code, compile_aside.at_hand(*wanted), value]))
"""


def test_another_process_compiles_and_the_disk_carries_it_over(tmp_path):
    assert in_a_fresh_process(ASIDE, tmp_path) == [False, 0, True, 1.5]
    assert in_a_fresh_process(ASIDE, tmp_path) == [True, None, True, 1.5]  # found on the disk, none started


def test_where_no_cache_can_be_written_the_call_itself_compiles(tmp_path, monkeypatch):
    nowhere = tmp_path / "file"
    nowhere.write_text("no folder")
    monkeypatch.setenv("WALLKIT_CACHE_DIR", str(nowhere))
    assert at_hand(compile_for, half, *kinds_of((np.float32(3),)))


def test_a_process_that_cannot_start_is_none(monkeypatch):
    monkeypatch.setattr(compile_aside.sys, "executable", "/no/such/python")
    assert at_hand(compile_for, half, *kinds_of((np.int8(3),)))


def test_never_compiling_refuses_this_thread_alone():
    with pytest.raises(NotCompiledError), never_compiling():
        compiled(half)(np.int16(3))
    assert compiled(half)(np.int16(3)) == 1.5


LONG = """
import json, time
from wallkit import Balls, Scene, Walls, simulate, survey
from wallkit.kernels import compile_aside
from wallkit.simulation import simulate as module
walls = Walls.from_polylines([[(0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (0.0, 30.0)]])
scene = Scene(walls, Balls([[11.0, 7.0]], [[3.0, 4.1]], radius=1.0))
waited = []
interpreted = module.fly
def fly(*arguments):  # as soon as another process compiles, wait for it: what follows is compiled
    for process in compile_aside._processes.values():
        if process is not None:
            waited.append(process.wait())
    return interpreted(*arguments)
module.fly = fly
run = simulate(scene, bounces=20_000)
print(json.dumps([waited[:1], len(waited), run.contacts.tobytes().hex()[-400:]]))
"""


def test_a_long_run_goes_over_from_interpreted_to_compiled_with_the_same_bits(tmp_path):
    waited, times, end = in_a_fresh_process(LONG, tmp_path)
    scene = Scene(Walls.from_polylines(ROOM), Balls([[11.0, 7.0]], [[3.0, 4.1]], radius=1.0))
    assert (waited, times) == ([0], 1)
    assert end == simulate(scene, bounces=20_000, mode="compiled").contacts.tobytes().hex()[-400:]


def test_after_warm_nothing_of_that_kind_is_compiled(said, tmp_path):
    drawing = tmp_path / "room.svg"
    path = '<path d="M0 0H40V30H0Z" fill="none" stroke="red"/>'
    drawing.write_text(f'<svg xmlns="http://www.w3.org/2000/svg">{path}</svg>')
    code, out, _ = said("warm", str(drawing))
    assert (code, out.splitlines()[0].split(" ... ")[0]) == (0, str(drawing))
    other = Scene(Walls.from_polylines([[(0, 0), (9, 0), (0, 9)]]), Balls(np.ones((300, 2)), np.ones((300, 2)), 0.1))
    with never_compiling():
        assert survey(other, bounces=3).bounces.sum() == 900
        one = replace(other, balls=Balls([[1, 1]], [[1, 0]], 0.1))
        assert len(simulate(one, bounces=3, mode="compiled").contacts) == 3
        assert len(aim(one, (1, 1), (3, 2, 0.2), bounces=1, radius=0.1)) > 0
