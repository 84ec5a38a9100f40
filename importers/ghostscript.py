"""Ghostscript as a reader, for those who ask for it: it runs a PostScript program and gives the paths as a PDF.

Off unless asked for by name, since it runs what the file says: without access to files (-dSAFER), in a folder of
its own, and with bounds on time, memory and what it may write.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path

from importers.drawing import Drawing
from importers.errors import DrawingError
from importers.illustrator.scanner import postscript_part
from importers.limits import MAX_INPUT_BYTES, limit_error
from importers.page_choice import PageChoice

_PROGRAMS = ("gs", "gswin64c", "gswin32c")
_SECONDS = 20
_MEMORY = 1 << 30
_BOX = re.compile(rb"%%(HiRes)?BoundingBox:[ \t]{0,9}([-+.\deE \t]{7,200})")
_HEADER = 8192
_CREATOR = re.compile(rb"%%Creator:[ \t]*([^\r\n]{1,80})")
_ROUNDING = 0.02  # Ghostscript gives the size of a page in hundredths of a point


def read_through_ghostscript(data: bytes, file: str = "", page: PageChoice = None) -> Drawing:
    """Run a PostScript program by Ghostscript and read what it draws: points, y up, in the file's own coordinates.

    Ghostscript gives numbers to six digits.

    Args:
        data: PostScript, with a DOS preview or without.
        file: its name, for messages.
        page: which page, as for :func:`importers.read.read_drawing`.

    Raises:
        DrawingError: it is no PostScript, Ghostscript is not there (``no-ghostscript``), or cannot run it
            (``postscript-program``).
        LimitError: it takes more than 20 seconds of the processor or writes more than may be read.
    """
    from importers.pdf import read_pdf

    start, stop = postscript_part(data)
    if not data[start : start + 200].lstrip().startswith(b"%!"):
        message = "Ghostscript is for PostScript, and this is none"
        raise DrawingError(message, code="not-a-drawing", fix="leave out via='ghostscript'", file=file)
    program = _find_program(file)
    pdf = _run(program, data[start:stop], file)
    drawing = read_pdf(pdf, file, page, origin=lambda box: _origin(data[start:stop], box))
    creator = _CREATOR.search(data, start, min(stop, start + _HEADER))
    by = f" by {creator.group(1).decode('latin-1').strip()}" if creator else ""
    drawing.kind = f"PostScript{by} (run by Ghostscript)"
    return drawing


def _find_program(file: str) -> str:
    """Find Ghostscript."""
    for name in _PROGRAMS:
        found = shutil.which(name)
        if found:
            return found
    fix = "install it (a package ghostscript), or convert the file to PDF or SVG elsewhere"
    raise DrawingError("Ghostscript is not on this machine", code="no-ghostscript", fix=fix, file=file)


def _run(program: str, data: bytes, file: str) -> bytes:
    """Let Ghostscript turn PostScript into a PDF."""
    with tempfile.TemporaryDirectory(prefix="wallkit-") as folder:
        source, result, words = (Path(folder) / name for name in ("in.ps", "out.pdf", "words.txt"))
        source.write_bytes(data)
        command = [program, "-q", "-P-", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-dEPSCrop", "-dAutoRotatePages=/None"]
        command += ["-dCompatibilityLevel=1.4", "-sDEVICE=pdfwrite", f"-sOutputFile={result.name}", source.name]
        with words.open("wb") as said:
            try:
                code = subprocess.run(
                    command,
                    cwd=folder,
                    # -dSAFER leaves the folder for temporary files open, also to what lies there of others.
                    env={**os.environ, "TMPDIR": folder, "TEMP": folder, "TMP": folder},
                    stdin=subprocess.DEVNULL,
                    stdout=said,
                    stderr=said,
                    timeout=3 * _SECONDS,
                    preexec_fn=_bounds(),
                    check=False,
                ).returncode
            except subprocess.TimeoutExpired:
                code = -9
        if code < 0:
            raise limit_error("time that Ghostscript may take", f"{_SECONDS} seconds", file=file)
        size = result.stat().st_size if result.exists() else 0
        if size > MAX_INPUT_BYTES:
            raise limit_error("size of what Ghostscript makes", f"{MAX_INPUT_BYTES >> 20} MiB", file=file)
        if code or not size:
            raise DrawingError(
                f"Ghostscript cannot run the program: {_first_words(words)}",
                code="postscript-program",
                fix="export the drawing again, as SVG or PDF if the program can",
                file=file,
            )
        return result.read_bytes()


def _bounds() -> Callable[[], None] | None:
    """Give what sets the bounds in Ghostscript's process; None where the system has none (there time alone counts)."""
    try:
        import resource
    except ImportError:
        return None

    def set_bounds() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (_SECONDS, _SECONDS))
        resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
        resource.setrlimit(resource.RLIMIT_FSIZE, (2 * MAX_INPUT_BYTES, 2 * MAX_INPUT_BYTES))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    return set_bounds


def _first_words(words: Path) -> str:
    """Give the first line that Ghostscript said."""
    with words.open("rb") as said:
        text = said.read(2000).decode("latin-1")
    line = next((line.strip() for line in text.splitlines() if line.strip()), "it gives no reason")
    return "".join(char if char.isprintable() else " " for char in line)[:200]


def _origin(data: bytes, box: tuple[float, float, float, float]) -> tuple[float, float]:
    """Tell how far Ghostscript has moved the lower left corner of an EPS to the origin of the page.

    Args:
        data: the PostScript.
        box: of the page that came out. Its size tells which of the boxes that the file names was taken, if any.
    """
    if b"EPSF-" not in data[:40]:
        return 0.0, 0.0
    boxes = [*_BOX.finditer(data, 0, _HEADER), *_BOX.finditer(data, max(len(data) - _HEADER, _HEADER))]
    for match in sorted(boxes, key=lambda found: found.group(1) is None):
        try:
            x1, y1, x2, y2 = map(float, match.group(2).split()[:4])
        except ValueError:
            continue
        if abs(x2 - x1 - (box[2] - box[0])) < _ROUNDING and abs(y2 - y1 - (box[3] - box[1])) < _ROUNDING:
            return x1 - box[0], y1 - box[1]
    return 0.0, 0.0
