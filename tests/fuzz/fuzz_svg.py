"""Coverage-guided fuzzing of the SVG reader: only WallkitError may leave it.

    pip install atheris
    python tests/fuzz/fuzz_svg.py -max_total_time=600 -max_len=4096 -timeout=10 CORPUS tests/importers/svg

CORPUS is a folder of its own that grows. A crasher is written to the current folder; put it into
tests/importers/svg_crashers under a name that tells its story, where test_svg_fuzz.py reads it in every run.
"""

import sys
from pathlib import Path

import atheris

sys.path.insert(0, str(Path(__file__).parents[2]))

with atheris.instrument_imports(include=["importers", "tinycss2", "cssselect2"]):
    import importers.boxes
    import importers.svg.reader
    import importers.svg.sheet
    import importers.svg.source
    from importers.errors import WallkitError
    from importers.svg import read_svg


def read(data: bytes) -> None:
    try:
        drawing = read_svg(data)
    except WallkitError:
        return
    importers.boxes.box_of(drawing.paths)
    drawing.to_json()


def main() -> None:
    atheris.Setup(sys.argv, read)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
