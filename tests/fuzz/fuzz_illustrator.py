"""Coverage-guided fuzzing of the Illustrator reader; run by hand, not by pytest.

    pip install atheris
    PYTHONPATH=. python tests/fuzz/fuzz_illustrator.py -max_total_time=600 FOLDER tests/importers/drawings

FOLDER keeps what the fuzzer finds interesting from run to run. Whatever leaves the reader that is no WallkitError
is a bug: keep the crasher as a fixture of tests/importers/test_illustrator_crashers.py.
"""

from __future__ import annotations

import json
import sys

import atheris

with atheris.instrument_imports(include=["importers"]):
    from importers.errors import WallkitError
    from importers.illustrator import read_illustrator


def read_once(data: bytes) -> None:
    """Read what the fuzzer made, twice: as it is, and as text that surely counts as Illustrator's."""
    for text in (data, b"0 0 m 1 1 l " + data):
        try:
            drawing = read_illustrator(text, "fuzz")
        except WallkitError:
            continue
        json.dumps(drawing.to_json(), allow_nan=False)


if __name__ == "__main__":
    atheris.Setup(sys.argv, read_once)
    atheris.Fuzz()
