"""The kinds of findings of the PDF reader; docs/illustrator.md lists them for people."""

from __future__ import annotations

from importers.findings import Kind

PAGE_CONTENT = Kind(
    "page-content",
    "info",
    "{what}; the page's own content was read instead, without names and without what is not on the page",
    "{what}; the page's own content was read instead, without names and without what is not on the page",
    "save the drawing again with Illustrator's editing capabilities, or as SVG, if layers or objects are missing",
)
STREAM = Kind(
    "damaged-stream",
    "error",
    "a part of the page cannot be read whole ({what}); what stands before the damage was read",
    "{count} parts of the page cannot be read whole (first: {what}); what stands before the damage was read",
    "save or export the drawing again",
)
USER_UNIT = Kind(
    "user-unit",
    "warning",
    "the page is drawn in units of {what} pt; coordinates are given as written, in those units",
    "the page is drawn in units of {what} pt; coordinates are given as written, in those units",
    "scale the walls by that number to have points",
)
ROTATED = Kind(
    "rotated-page",
    "info",
    "viewers show the page turned by {what} degrees; coordinates are those of the page as drawn",
    "viewers show the page turned by {what} degrees; coordinates are those of the page as drawn",
    "turn the page in the drawing program if the walls are to stand as they are shown",
)
SHADING = Kind(
    "shading-left-out",
    "info",
    "a shading is left out",
    "{count} shadings are left out",
    "draw its outline if it is to be a wall",
)
RECURSIVE = Kind(
    "recursive-form",
    "error",
    "a form draws itself; the inner drawing is left out",
    "forms draw themselves {count} times; the inner drawings are left out",
    "save or export the drawing again",
)
MISSING = Kind(
    "missing-object",
    "error",
    "the page draws {what}, which the file does not hold",
    "the page draws {count} objects that the file does not hold (first {what})",
    "save or export the drawing again",
)
NUMBER = Kind(
    "bad-number",
    "error",
    "the transform that {what} sets has numbers too large to compute with; what is drawn with it is left out",
    "{count} transforms (first by {what}) have numbers too large to compute with; what is drawn with them is left out",
    "correct the numbers, or save or export the drawing again",
)
MASK = Kind(
    "mask-not-applied",
    "warning",
    "a shape under a soft mask, or under hundreds of clips, is taken whole",
    "{count} shapes under soft masks, or under hundreds of clips, are taken whole",
    "cut them in the drawing program if their walls are to end there",
)
TILING = Kind(
    "pattern-left-out",
    "info",
    "a shape is painted with a tiling pattern, whose own art is left out",
    "{count} shapes are painted with tiling patterns, whose own art is left out",
    "draw the tiles as shapes of their own (in a drawing program: expand the pattern) if they are to be walls",
)
ANNOTATION = Kind(
    "annotation-left-out",
    "warning",
    "an annotation ({what}) that the page shows is left out",
    "{count} annotations (first a {what}) that the page shows are left out",
    "draw them into the page, for example with: gs -o out.pdf -sDEVICE=pdfwrite -dPreserveAnnots=false in.pdf",
)
