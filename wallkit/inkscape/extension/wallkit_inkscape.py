"""Run wallkit on Inkscape's document by the Python that has it. Written by `wallkit inkscape --install`."""

import os
import subprocess
import sys

PYTHON = "@PYTHON@"
FOLDER = "@FOLDER@"


def main() -> int | str:
    """Pass the call on; an exit status, or what is wrong."""
    # Inkscape may come with a Python of its own and say to all of them where that is.
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONHOME", "PYTHONPATH")}
    environment["PYTHONPATH"] = FOLDER
    try:
        return subprocess.run([PYTHON, "-m", "wallkit.inkscape", *sys.argv[1:]], env=environment).returncode
    except OSError as error:
        return f"{PYTHON} does not run ({error.strerror}): install wallkit's extensions again by its own command"


if __name__ == "__main__":
    sys.exit(main())
