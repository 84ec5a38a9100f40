"""`wallkit inkscape`: put wallkit's extensions where Inkscape finds them."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Annotated

import typer

HERE = Path(__file__).parents[1] / "inkscape" / "extension"
SCRIPT = "wallkit_inkscape.py"


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("inkscape", rich_help_panel="Drawings and walls")(inkscape)


def inkscape(
    install: Annotated[
        bool, typer.Option("--install", help="Copy them there; without it, only say where that is.")
    ] = False,
    to: Annotated[
        str, typer.Option("--to", metavar="DIR", help="Inkscape's folder for extensions, where it is not found.")
    ] = "",
) -> None:
    """Install the extensions for Inkscape 1.0 and later: Extensions > wallkit > Check, Shoot, Export."""
    folder = Path(to).expanduser() if to else extensions_folder()
    if not install:
        print(f"{folder} is where they go: wallkit inkscape --install")
        return
    for name in install_into(folder):
        print(f"wrote {folder / name}")
    print("Start Inkscape again: they are under Extensions > wallkit.", file=sys.stderr)


def extensions_folder() -> Path:
    """Find the folder of a user's own extensions, as Inkscape does: by its variable, else by the system's custom."""
    profile = os.environ.get("INKSCAPE_PROFILE_DIR")
    if profile:
        return Path(profile) / "extensions"
    home = Path.home()
    if sys.platform == "win32":
        return Path(os.environ.get("APPDATA", home / "AppData" / "Roaming")) / "inkscape" / "extensions"
    if sys.platform == "darwin":
        return home / "Library/Application Support/org.inkscape.Inkscape/config/inkscape/extensions"
    return Path(os.environ.get("XDG_CONFIG_HOME") or home / ".config") / "inkscape" / "extensions"


def install_into(folder: Path) -> list[str]:
    """Write the extensions into a folder, and give their files' names.

    The script runs the Python that this runs in, by its path: Inkscape has a Python of its own, without wallkit.

    Raises:
        FileError: the folder or a file cannot be written.
    """
    from wallkit.write_file import FileError, write_whole

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        message = f"cannot make the folder {folder}: {error.strerror or error}"
        raise FileError(message, code="cannot-write", fix="give another with --to") from error
    names = sorted(path.name for path in HERE.iterdir() if path.suffix in (".inx", ".py"))
    for name in names:
        text = (HERE / name).read_text(encoding="utf-8")
        if name == SCRIPT:
            text = text.replace('"@PYTHON@"', repr(sys.executable)).replace('"@FOLDER@"', repr(str(HERE.parents[2])))
        write_whole(folder / name, text)
    return names
