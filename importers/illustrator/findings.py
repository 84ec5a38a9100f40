"""The kinds of findings of the Illustrator reader; docs/illustrator.md lists them for people."""

from __future__ import annotations

from importers.findings import Kind

TEXT = Kind(
    "text-left-out",
    "info",
    "a text object is left out",
    "{count} text objects are left out",
    "to make walls of letters, create outlines of the text before saving",
)
RASTER = Kind(
    "image-left-out",
    "info",
    "a pixel image is left out",
    "{count} pixel images are left out",
    "trace the image if its shapes are to be walls",
)
PLACED = Kind(
    "placed-file-left-out",
    "warning",
    "a placed file is left out",
    "{count} placed files are left out",
    "embed the placed file before saving, or import it by itself",
)
OBJECT = Kind(
    "object-left-out",
    "warning",
    "an object of the kind {what} is left out",
    "{count} objects of the kind {what} are left out",
    "make plain paths of it (Object > Expand, or break the link to the symbol) before saving",
)
UNKNOWN = Kind(
    "unknown-operator",
    "info",
    "the operator {what} is not known and was skipped",
    "the operator {what} is not known and was skipped {count} times",
    "if something is missing from the drawing, save it as SVG or as Illustrator 8",
)
OPERANDS = Kind(
    "bad-operands",
    "error",
    "the operator {what} has not the numbers that it needs; its path ends before it",
    "{count} operators have not the numbers that they need (first {what}); each path ends before such an operator",
    "correct the line, or save the drawing again",
)
NO_POINT = Kind(
    "no-current-point",
    "error",
    "{what} draws from nowhere: no point was set; its path begins at its end",
    "{count} segments draw from nowhere (first {what}): no point was set; each path begins at the segment's end",
    "begin each path with its first point: x y m",
)
COORDINATE = Kind(
    "bad-coordinate",
    "error",
    "a path has a coordinate that is not a number up to 1,000,000,000; the path is left out",
    "{count} paths have a coordinate that is not a number up to 1,000,000,000; they are left out",
    "correct the number, or draw nearer to the origin",
)
STRING = Kind(
    "open-string",
    "error",
    "a text in parentheses does not end; it is skipped up to the end of its line",
    "{count} texts in parentheses do not end; each is skipped up to the end of its line",
    "close the parenthesis, or save the drawing again",
)
UNBALANCED = Kind(
    "unbalanced",
    "warning",
    "{what} closes what was not opened",
    "{count} operators close what was not opened (first {what})",
    "groups or layers may be wrong; the shapes are not affected",
)
DATA = Kind(
    "bad-data",
    "error",
    "a block of data does not end where it says",
    "{count} blocks of data do not end where they say",
    "the file was probably changed by a text program; save the drawing again",
)
PAGES = Kind(
    "several-pages",
    "warning",
    "the file has another page; only the first is read",
    "the file has {count} more pages; only the first is read",
    "choose a page by its number, or all pages; or save each page as a file of its own",
)
ATTRIBUTE = Kind(
    "bad-attribute",
    "warning",
    "the operator {what} has not the operands that it needs; it is skipped",
    "{count} operators that set attributes have not the operands that they need (first {what}); they are skipped",
    "colours, groups or layers may be wrong; the shapes are not affected",
)
PRIVATE_DAMAGED = Kind(
    "damaged-stream",
    "error",
    "Illustrator's own data are damaged ({what}); what stands before the damage was read",
    "Illustrator's own data are damaged ({what}); what stands before the damage was read",
    "save the drawing again",
)
LARGE_CANVAS = Kind(
    "large-canvas",
    "warning",
    "the drawing is on a large canvas: its coordinates are in units of {what} pt and are given as written",
    "the drawing is on a large canvas: its coordinates are in units of {what} pt and are given as written",
    "scale the walls by that number to have points",
)
CLIP = Kind(
    "clip-not-applied",
    "warning",
    "a shape under a clipping path is taken whole",
    "{count} shapes under clipping paths are taken whole",
    "cut them there (--apply-clips), or in the drawing program, if their walls are to end there",
)
OUTSIDE = Kind(
    "outside-clip",
    "warning",
    "a shape is wholly outside its clipping path, so nothing of it is seen",
    "{count} shapes are wholly outside their clipping paths, so nothing of them is seen",
    "leave them out with --apply-clips, or delete them, if they are to be no walls",
)
