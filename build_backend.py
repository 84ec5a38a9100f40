"""How wheels are made: hatchling's way, and on Linux x86-64 with kernels compiled for several levels of processors.

Nobody who installs such a wheel waits for a compiler. Wherever kernels cannot be compiled (another platform, an
editable install, a compiler that fails, ``WALLKIT_PURE_WHEEL`` set) a pure wheel comes out, whose kernels are compiled
when they are first used.
"""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from hatchling.build import *  # noqa: F403  the hooks of PEP 517, of which the one below is another
from hatchling.build import get_requires_for_build_wheel as _requires_of_hatchling
from hatchling.builders.hooks.plugin.interface import BuildHookInterface

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT))

from wallkit.kernels.shipped_code import has_levels, levels_here, settings_for  # noqa: E402  needs nothing but Python

TAG = "py3-none-manylinux_2_17_x86_64"
"""Any Python; machine code takes square roots and copies of memory from the C library, which all versions have."""


def get_requires_for_build_wheel(config_settings: dict[str, Any] | None = None) -> list[str]:
    """Compiling kernels takes what running them takes: wallkit opens its samples and flies balls in them."""
    return [*_requires_of_hatchling(config_settings), *(_dependencies() if _compiles() else [])]


def _dependencies() -> list[str]:
    import tomllib

    with (ROOT / "pyproject.toml").open("rb") as file:
        dependencies: list[str] = tomllib.load(file)["project"]["dependencies"]
    return dependencies


def _compiles() -> bool:
    return has_levels() and platform.libc_ver()[0] == "glibc" and not os.environ.get("WALLKIT_PURE_WHEEL")


class Kernels(BuildHookInterface):
    """Compile kernels into the wheel."""

    PLUGIN_NAME = "kernels"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile, and say what came of it; an editable install gets nothing."""
        if version == "editable" or not _compiles():
            self.app.display_info("wallkit: a pure wheel; kernels are compiled when they are first used")
            return
        self._made = Path(tempfile.mkdtemp(prefix="wallkit-kernels-"))
        running = {level: self._begin(level) for level in levels_here()}  # side by side
        done = [level for level, process in running.items() if self._taken(level, process)]
        if done:
            build_data["force_include"][str(self._made / "shipped")] = "wallkit/kernels/shipped"
            build_data["pure_python"], build_data["tag"] = False, TAG
        told = f"with kernels for {' and '.join(done)}" if done else "pure: no kernels could be compiled"
        self.app.display_info(f"wallkit: the wheel is {told}")

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Tidy up."""
        if (made := getattr(self, "_made", None)) is not None:
            shutil.rmtree(made, ignore_errors=True)

    def _begin(self, level: str) -> subprocess.Popen[bytes]:
        """Compile what ``wallkit warm`` does, for a level instead of this processor."""
        others = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA_")}
        paths = os.pathsep.join(filter(None, [str(ROOT), *sys.path]))
        here = {"WALLKIT_CACHE_DIR": str(self._made / level), "PYTHONPATH": paths, "PYTHONDONTWRITEBYTECODE": "1"}
        with (self._made / f"{level}.log").open("wb") as log:
            command, env = [sys.executable, "-m", "wallkit", "warm"], {**others, **here, **settings_for(level)}
            return subprocess.Popen(command, cwd=ROOT, env=env, stdout=log, stderr=log)

    def _taken(self, level: str, process: subprocess.Popen[bytes]) -> bool:
        """Wait for what compiles, and take over what it made."""
        failed, found = process.wait(), [*(self._made / level).glob("kernels-*/*/")]
        if failed or len(found) != 1:
            told = (self._made / f"{level}.log").read_text(errors="replace")
            self.app.display_warning(f"wallkit: kernels could not be compiled for {level}:\n{told[-2000:]}")
            return False
        target = self._made / "shipped" / found[0].parent.name / level
        target.parent.mkdir(parents=True, exist_ok=True)
        found[0].rename(target)
        return True
