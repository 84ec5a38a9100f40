"""The points of an LWPOLYLINE for ezdxf, whose text is made a block at a time. Imported late: it brings ezdxf.

ezdxf (1.4) lists the tags of a polyline, some 150 bytes for each point, before it writes the first of them. Here a
tag stands for a block of points, and gives the text of all their tags when it is written.
"""

from __future__ import annotations

from collections.abc import Iterator

from ezdxf.entities.lwpolyline import LWPolylinePoints
from ezdxf.lldxf.types import DXFTag

from wallkit.export.number_text import BLOCK
from wallkit.geometry.arrays import FloatArray


class Block(DXFTag):
    """So many points as one tag."""

    __slots__ = ()

    def dxfstr(self) -> str:
        """Give the text of the tags of all its points."""
        return "".join(tag.dxfstr() for tag in self.value.dxftags())


class Points(LWPolylinePoints):
    """Points of a polyline: (n, 5) x, y, width at its start and end, bulge."""

    def __init__(self, values: FloatArray) -> None:
        super().__init__()
        self.values = values

    def dxftags(self) -> Iterator[DXFTag]:
        """Give them as blocks."""
        for start in range(0, len(self.values), BLOCK):
            block = LWPolylinePoints()
            block.values = self.values[start : start + BLOCK]
            yield Block(self.VERTEX_CODE, block)
