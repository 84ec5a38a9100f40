"""The three extensions: each takes the document and its options, and gives the document back.

Inkscape shows standard error in a dialog and waits for it, so only errors go there: what was found stands on a layer.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from importers.errors import WallkitError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from wallkit.inkscape.document import Document
    from wallkit.walls.import_options import ImportOptions


def main(arguments: Sequence[str]) -> int:
    """Run an extension; 0, or 1 and one message where it cannot be done."""
    options = _options(arguments)
    from wallkit.inkscape.document import Document

    try:
        document = Document(Path(options.document).read_bytes())
        {"check": check, "shoot": shoot, "export": export}[options.effect](document, options)
    except WallkitError as error:
        print(f"{error.message}{'. ' + error.fix[:1].upper() + error.fix[1:] if error.fix else ''}.", file=sys.stderr)
        return 1
    sys.stdout.buffer.write(document.to_bytes())
    return 0


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    """Read what Inkscape says; objects that are selected (--id) and what a later version adds do not matter."""
    parser = argparse.ArgumentParser(prog="wallkit.inkscape", allow_abbrev=False)
    parser.add_argument("document")
    parser.add_argument("--effect", choices=("check", "shoot", "export"), required=True)
    parser.add_argument("--outermost", choices=("drawn", "solid", "room"), default="drawn")
    for name in ("radius", "angle", "speed", "gravity", "grid", "target_scale"):
        parser.add_argument(f"--{name}", type=float, default=0.0)
    parser.add_argument("--restitution", type=float, default=1.0)
    parser.add_argument("--bounces", type=int, default=20)
    parser.add_argument("--aim", choices=("true", "false"), default="false")
    parser.add_argument("--out", default="")
    parser.add_argument("--format", default="")
    parser.add_argument("--origin", default="page")
    return parser.parse_known_args(arguments)[0]


def _importing(options: argparse.Namespace, **more: Any) -> ImportOptions:
    from wallkit.walls.import_options import ImportOptions

    outermost = options.outermost
    usual = {"curves": "arcs", "solid": outermost == "solid", "arena": outermost == "room"}
    return ImportOptions(**(usual | more))


def check(document: Document, options: argparse.Namespace) -> None:
    """Put what `wallkit check` finds on a layer: numbered marks, the ways through leaks, the words below."""
    from wallkit.cli.messages import count_by_severity
    from wallkit.scene.look_over import given_of, look_over
    from wallkit.scene.opening import open_scene
    from wallkit.scene.wishes import Wishes
    from wallkit.view.picture import walls_marks

    found = open_scene(document.data, Wishes(importing=_importing(options), put_ball=False))
    look = look_over(given_of(found), options.radius or None)
    told = f"wallkit check: {count_by_severity(look.problems)}"
    canvas, frame = walls_marks(look.walls, look.problems, ways=[gap.path for gap in look.reach.leaks], note=told)
    document.put_layer("check", canvas, frame)


def shoot(document: Document, options: argparse.Namespace) -> None:
    """Put the path of each ball and its ghosts on a layer: the balls drawn, or one where there is most room."""
    from wallkit.scene.opening import open_scene
    from wallkit.scene.wishes import Wishes
    from wallkit.simulation.simulate import simulate
    from wallkit.view.run_picture import run_marks

    aimed = options.aim == "true"
    wishes = Wishes(
        speed=options.speed if aimed else None,
        angle=options.angle if aimed else None,
        radius=options.radius or None,
        gravity=(0.0, options.gravity) if options.gravity else None,
        restitution=None if options.restitution == 1.0 else options.restitution,
        bounces=options.bounces,
        importing=_importing(options),
    )
    found = open_scene(document.data, wishes)
    document.put_layer("shot", *run_marks(simulate(found.scene, found.until, found.bounces)))


def export(document: Document, options: argparse.Namespace) -> None:
    """Write the level where the options say; the document stays as it is."""
    from wallkit.cli.export import page_of
    from wallkit.export import export as write
    from wallkit.export.formats import find_format
    from wallkit.scene.opening import open_scene
    from wallkit.scene.wishes import UsageError, Wishes

    if not options.out:
        raise UsageError("no file is named", code="usage", fix="say where to write the level")
    out = Path(options.out).expanduser()
    chosen = find_format(out, None if options.format in ("", "ending") else options.format)
    importing = _importing(options) if chosen.arcs else _importing(options, curves="lines")
    found = open_scene(document.data, Wishes(importing=importing, put_ball=False))
    page = None if found.drawing is None else page_of(found.drawing)
    scale = options.target_scale or None
    write(found.scene.walls, out, chosen.name, scale=scale, origin=options.origin, page=page, grid=options.grid)
