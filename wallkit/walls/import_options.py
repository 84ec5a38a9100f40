"""Import options: how a drawing becomes walls, in one frozen value that every way in shares.

Commands, scene files (``[import]``), the page and ``import_walls`` differ in how they are asked, not in what may be
said: the names here are the keywords of the library, the keys of the table and, with ``-`` for ``_``, the options of
the command line.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, Literal, NamedTuple, TypedDict

from importers.limits import MAX_COORDINATE
from importers.page_choice import PageChoice
from wallkit import arguments
from wallkit.walls.repairing.repairs import Repairs
from wallkit.walls.walls import Sides, WallsError

Curves = Literal["lines", "arcs"]
INCH = {"px": 96.0, "pt": 72.0, "mm": 25.4, "cm": 2.54, "m": 0.0254, "in": 1.0}
"""So many of each are an inch: CSS fixes the px, PostScript the point."""

_FLAGS = (
    "hidden", "unpainted", "outline_strokes", "apply_clips", "arena", "solid", "flip_y",
    "join", "drop_duplicates", "resolve", "union",
)  # fmt: skip
_LENGTHS = ("snap", "min_width", "simplify", "grid")
REPAIRS = ("snap", "join", "drop_duplicates", "resolve", "union", "min_width", "simplify")
"""These act on walls that are no drawing any more, too."""


class ImportWishes(TypedDict, total=False):
    """The keywords of ``import_walls``: see :class:`ImportOptions`."""

    tolerance: float | None
    curves: Curves
    layers: Sequence[str] | None
    hidden: bool
    unpainted: bool
    outline_strokes: bool
    apply_clips: bool
    via: str
    arena: bool
    solid: bool
    room: str
    sides: Sides
    scale: float
    flip_y: bool
    snap: float
    join: bool
    drop_duplicates: bool
    resolve: bool
    union: bool
    min_width: float
    simplify: float
    repairs: Repairs | None
    page: PageChoice
    units: str
    origin: str
    grid: float


@dataclass(frozen=True, slots=True)
class ImportOptions:
    """How a drawing becomes walls.

    Attributes:
        tolerance: the largest distance between a curve and its edges, in the drawing's units; None for 0.1 % of the
            diagonal of what is taken, at most 0.1.
        curves: ``"lines"`` or ``"arcs"``.
        layers: globs on layer and group names; only these are taken; None for all.
        hidden: take hidden paths too.
        unpainted: take paths that have neither fill nor stroke although others are painted.
        outline_strokes: a stroke with a width becomes the solid that it paints.
        apply_clips: paths end where clips end that are drawn as paths; what of a path is not seen is left out.
        arena: the outermost closed walls are rooms: what is inside is free, material is outside.
        solid: the outermost closed walls are solid.
        room: a name or glob: the closed walls of that name are rooms. At most one of these three is given; without
            any, paint and balls decide (:func:`wallkit.walls.solid.decide`).
        sides: ``"both"`` or ``"outward"``, for closed walls; open ones are always two-sided.
        scale: factor on all coordinates; the places of problems are scaled too.
        flip_y: mirror the y axis (SVG's points down).
        snap: repair: open ends this near to one another or to a wall are moved together, and joined; drawing's units.
        join: repair: open walls whose ends meet become one.
        drop_duplicates: repair: walls and edges drawn twice go.
        resolve: repair: walls that cross themselves become the outline of what they enclose.
        union: repair: overlapping and touching solids become one.
        min_width: repair: closed walls that no disc of this diameter fits into go; drawing's units.
        simplify: repair: vertices go where the wall then moves by at most this; drawing's units.
        via: ``"ghostscript"`` lets that program, which must be installed, run PostScript; ``""`` runs none.
        page: which page or artboard, from 1; ``"all"`` for all; None as :func:`importers.read.read_drawing` has it.
        units: of all lengths and places: ``"px"``, ``"pt"``, ``"mm"``, ``"cm"``, ``"m"`` or ``"in"``, by the drawing's
            physical size; or a scale as on a map, such as ``"1 m = 100 px"``. ``""`` leaves those of the file.
        origin: what becomes (0, 0): ``"page"`` and ``"box"`` for the corner of smallest coordinates of the page, or of
            the box of what is visible; ``"X,Y"`` for that point, in these units; ``""`` leaves it.
        grid: vertices go to the nearest multiples of this, in the units of the result; 0 leaves them.

    Raises:
        WallsError: a value is none that may be; the message names the key, what was given and what may be.
    """

    tolerance: float | None = None
    curves: Curves = "lines"
    layers: tuple[str, ...] | None = None
    hidden: bool = False
    unpainted: bool = False
    outline_strokes: bool = False
    apply_clips: bool = False
    arena: bool = False
    solid: bool = False
    room: str = ""
    sides: Sides = "both"
    scale: float = 1.0
    flip_y: bool = False
    snap: float = 0.0
    join: bool = False
    drop_duplicates: bool = False
    resolve: bool = False
    union: bool = False
    min_width: float = 0.0
    simplify: float = 0.0
    page: PageChoice = None
    units: str = ""
    origin: str = ""
    grid: float = 0.0
    via: str = ""

    def __post_init__(self) -> None:
        for name in _FLAGS:
            if not isinstance(getattr(self, name), bool):
                raise self._wrong(name, "give true or false")
        for name in _LENGTHS:
            self._number(name, least=0.0, most=MAX_COORDINATE)
        if self.tolerance is not None:
            self._number("tolerance", least=0.0, above=True)
        self._number("scale", least=0.0, above=True)
        self._word("curves", ("lines", "arcs"))
        self._word("sides", ("both", "outward"))
        if not isinstance(self.units, str) or (self.units and scale_of(self.units) is None):
            raise self._wrong("units", f'give one of {", ".join(INCH)}, or a scale such as "1 m = 100 px"')
        self._word("via", ("", "ghostscript"))
        self._place()
        self._names()
        said = [name for name in ("arena", "solid", "room") if getattr(self, name)]
        if len(said) > 1:
            raise WallsError(f"{' and '.join(said)} do not go together", code="bad-option", fix="give one of them")

    @classmethod
    def of(cls, **wishes: Any) -> ImportOptions:
        """Make options of the keywords of ``import_walls``, among them ``repairs``.

        Raises:
            WallsError: a keyword or a value is none that may be.
        """
        repairs = wishes.pop("repairs", None)
        if repairs is not None:
            if not isinstance(repairs, Repairs):
                raise WallsError(f"repairs is {repairs!r}", code="bad-option", fix="give a Repairs, or None")
            wishes = {f.name: getattr(repairs, f.name) for f in fields(Repairs) if getattr(repairs, f.name)} | wishes
        known = option_names()
        for name in wishes:
            if name not in known:
                raise WallsError(f"there is no option {name!r}", code="bad-option", fix=f"one of: {', '.join(known)}")
        return cls(**wishes)

    @property
    def repairs(self) -> Repairs | None:
        """The passes to run, lengths in the units of the result; None for none."""
        asked = Repairs(
            snap=self.snap * self.scale,
            join=self.join,
            drop_duplicates=self.drop_duplicates,
            resolve=self.resolve,
            union=self.union,
            min_width=self.min_width * self.scale,
            simplify=self.simplify * self.scale,
        )
        return None if asked == Repairs() else asked

    def said(self, usual: ImportOptions) -> dict[str, Any]:
        """Give, by name, the options that differ from the usual ones."""
        pairs = ((name, getattr(self, name)) for name in option_names())
        return {name: value for name, value in pairs if value != getattr(usual, name)}

    def _number(self, name: str, least: float, above: bool = False, most: float = math.inf) -> None:
        may_be = f"a number {'above' if above else 'from'} {least:g}" + (f" to {most:g}" if most < math.inf else "")
        least = math.nextafter(least, math.inf) if above else least
        value = getattr(self, name)
        found = arguments.number(value, name, may_be, error=WallsError, code="bad-option", least=least, most=most)
        object.__setattr__(self, name, found)

    def _word(self, name: str, words: tuple[str, ...]) -> None:
        if getattr(self, name) not in words:
            raise self._wrong(name, "give " + " or ".join(f'"{word}"' for word in words))

    def _place(self) -> None:
        page = self.page
        whole = isinstance(page, int) and not isinstance(page, bool) and page >= 1
        if not (page is None or page == "all" or whole):
            raise self._wrong("page", "give a number from 1, or all")
        if not isinstance(self.origin, str) or (
            self.origin not in ("", "page", "box") and point_of(self.origin) is None
        ):
            raise self._wrong("origin", "give page, box, or X,Y")

    def _names(self) -> None:
        if not isinstance(self.room, str):
            raise self._wrong("room", "give a wall's name or a glob")
        layers = self.layers
        if layers is None:
            return
        if isinstance(layers, str) or not isinstance(layers, Sequence) or not all(isinstance(g, str) for g in layers):
            raise self._wrong("layers", 'give a list of globs, such as ["walls*"]')
        object.__setattr__(self, "layers", tuple(layers))

    def _wrong(self, name: str, fix: str) -> WallsError:
        return WallsError(f"{name} is {getattr(self, name)!r}", code="bad-option", fix=fix)


def scale_of(units: str) -> Scale | None:
    """Read units or a scale: ``m`` is the scale "1 m = 1 m"; None where it is something else."""
    sides = [side.split() for side in re.sub(r"([0-9.])([a-z]+ *(=|$))", r"\1 \2", units).split("=")]
    if len(sides) == 1 and units in INCH:
        return Scale(units, 1.0, 1.0, units)
    try:
        (shown, name), (drawn, of) = ((float(side[0]), side[1]) for side in sides if len(side) == 2)
    except (ValueError, IndexError):
        return None
    fit = len(sides) == 2 and name in INCH and of in INCH and 0.0 < shown < math.inf and 0.0 < drawn < math.inf
    return Scale(name, shown, drawn, of) if fit else None


class Scale(NamedTuple):
    """So many units are shown for so many of others on the drawing's paper, as on a map: ``shown name = drawn of``."""

    name: str
    shown: float
    drawn: float
    of: str


def point_of(text: str) -> tuple[float, float] | None:
    """Read ``X,Y``; None where it is something else."""
    try:
        x, y = map(float, text.split(","))
    except ValueError:
        return None
    return (x, y) if math.isfinite(x) and math.isfinite(y) else None


def option_names() -> tuple[str, ...]:
    """List the names of all options."""
    return tuple(f.name for f in fields(ImportOptions))


def as_option(name: str) -> str:
    """Name an option as the command line does."""
    return "--layer" if name == "layers" else "--" + name.replace("_", "-")
