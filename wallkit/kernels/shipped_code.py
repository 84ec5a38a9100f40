"""Machine code that comes with a wheel: compiled when it was made, for each of a few levels of processors.

A wheel made on Linux for x86-64 has it (``build_backend.py``); a checkout has not. All levels give the same bits: LLVM
fuses, reorders and approximates nothing that it is not told to, and kernels do not tell it to (no fastmath).
"""

from __future__ import annotations

import os
import sys
from functools import cache
from pathlib import Path

_V2 = "cx16 popcnt sahf sse3 sse4.1 sse4.2 ssse3"
_V3 = f"{_V2} avx avx2 bmi bmi2 f16c fma lzcnt movbe"
LEVELS = {"x86-64-v4": f"{_V3} avx512bw avx512cd avx512dq avx512f avx512vl", "x86-64-v3": _V3, "x86-64-v2": _V2}
"""The levels of processors that wheels have machine code for, best first, with what each has as LLVM names it: those
that the x86-64 psABI defines. Vectors of 8, 4 and 2 numbers: what they bring is in docs/performance.md."""
SHIPPED = Path(__file__).parent / "shipped"


def has_levels() -> bool:
    """Tell whether this is where machine code is shipped for: Linux on x86-64."""
    return sys.platform == "linux" and os.uname().machine == "x86_64" and sys.maxsize > 2**32


def settings_for(level: str) -> dict[str, str]:
    """Give what to set so that kernels are compiled for a level, whatever processor compiles."""
    wide = "-prefer-256-bit" if level == "x86-64-v4" else ""  # LLVM would take vectors of 4 where there are 8
    return {"WALLKIT_CPU_NAME": level, "WALLKIT_CPU_FEATURES": wide}


@cache
def shipped_folders() -> tuple[Path, ...]:
    """Give the folders of shipped machine code that are here and that this processor can run, the fastest first.

    Those of other sources do not count: the digest of the kernels' sources, which are how they are called too, is in
    the name. Nor do any where another processor is set.
    """
    from wallkit.kernels.machine_code import settings, sources  # NumPy, which is not yet there when a wheel is begun

    made = SHIPPED / f"kernels-{sources()}"
    if not has_levels() or settings() or not made.is_dir():
        return ()
    return tuple(folder for level in levels_here() if (folder := made / level).is_dir())


def levels_here() -> list[str]:
    """Give the levels that this processor belongs to, best first."""
    features = _features()
    return [level for level, needs in LEVELS.items() if features.issuperset(needs.split())]


def _features() -> set[str]:
    """What this processor has, and the system lets programs use."""
    from llvmlite import binding

    try:
        return {name for name, there in binding.get_host_cpu_features().items() if there}
    except RuntimeError:  # LLVM does not know
        return set()
