"""How wheels are made: hatchling's way, and on Linux x86-64 with compiled kernels.

Nobody who installs such a wheel waits for a compiler. ``WALLKIT_WHEEL_KERNELS`` says for which levels of processors:
``here`` for the best one of this machine, which is what is done unless it is set, ``all`` for those up to it, as
releases have them, ``none`` for none. Then, and wherever kernels cannot be compiled (another platform, an editable
install, a compiler that fails), a pure wheel comes out, whose kernels are compiled when they are first used.
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
    wanted = os.environ.get("WALLKIT_WHEEL_KERNELS", "here")
    if wanted not in ("here", "all", "none"):
        raise SystemExit(f"WALLKIT_WHEEL_KERNELS is {wanted!r}: make it here, all or none")
    return has_levels() and platform.libc_ver()[0] == "glibc" and wanted != "none"


def _levels() -> list[str]:
    return levels_here() if os.environ.get("WALLKIT_WHEEL_KERNELS") == "all" else levels_here()[:1]


class Kernels(BuildHookInterface):
    """Compile kernels into the wheel."""

    PLUGIN_NAME = "kernels"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile, and say what came of it; an editable install gets nothing."""
        if version == "editable" or not _compiles():
            self.app.display_info("wallkit: a pure wheel; kernels are compiled when they are first used")
            return
        self._made = Path(tempfile.mkdtemp(prefix="wallkit-kernels-"))
        done = [level for level in _levels() if self._compile(level)]
        if done:
            build_data["force_include"][str(self._made / "shipped")] = "wallkit/kernels/shipped"
            build_data["pure_python"], build_data["tag"] = False, TAG
        told = f"with kernels for {' and '.join(done)}" if done else "pure: no kernels could be compiled"
        self.app.display_info(f"wallkit: the wheel is {told}")

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Tidy up."""
        if (made := getattr(self, "_made", None)) is not None:
            shutil.rmtree(made, ignore_errors=True)

    def _compile(self, level: str) -> bool:
        """Compile what ``wallkit warm`` does, for a level instead of this processor; take over what it made."""
        paths = os.pathsep.join(filter(None, [str(ROOT), *sys.path]))
        here = {"WALLKIT_CACHE_DIR": str(self._made / level), "PYTHONPATH": paths, "PYTHONDONTWRITEBYTECODE": "1"}
        command, env = [sys.executable, "-m", "wallkit", "warm"], {**os.environ, **here, **settings_for(level)}
        ran = subprocess.run(command, cwd=ROOT, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        found = [*(self._made / level).glob("kernels-*/*/")]
        if ran.returncode or len(found) != 1:
            told = ran.stdout.decode(errors="replace")
            self.app.display_warning(f"wallkit: kernels could not be compiled for {level}:\n{told[-2000:]}")
            return False
        target = self._made / "shipped" / found[0].parent.name / level
        target.parent.mkdir(parents=True, exist_ok=True)
        found[0].rename(target)
        return True
