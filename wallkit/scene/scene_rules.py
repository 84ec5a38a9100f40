"""What a scene file says about walls: by their colour, layer, group and name.

What a drawing says of its own walls goes before it.
A rule is one table of ``[colours]`` or ``[[materials]]``: those by colour first, then the others in the file's order,
the last that fits winning key by key. A word in the drawing (docs/tags.md) goes before them all.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase

from wallkit.walls import Walls
from wallkit.walls.fields import Sides
from wallkit.walls.roles import material_keys_of, sides_of
from wallkit.walls.tags import MATERIAL_KEYS

RULE_KEYS = (*MATERIAL_KEYS, "sides")


@dataclass(frozen=True, slots=True)
class Rule:
    """What is said of the walls that fit; None where nothing is."""

    restitution: float | None = None
    tangential_restitution: float | None = None
    static_friction: float | None = None
    sides: Sides | None = None


class Ruled:
    """Walls while rules are applied to them."""

    def __init__(self, walls: Walls) -> None:
        self._walls = walls
        self._materials = list(walls.materials)
        self._sides = list(walls.sides)

    def apply(self, rule: Rule, walls: Iterable[int]) -> None:
        """Let a rule hold for walls, but for what their tags say."""
        for index in walls:
            tags = self._walls.origins[index].tags
            given = {key: getattr(rule, key) for key in MATERIAL_KEYS if key not in material_keys_of(tags)}
            given = {key: value for key, value in given.items() if value is not None}
            if given:
                self._materials[index] = replace(self._materials[index], **given)
            if rule.sides is not None and sides_of(tags) is None:
                self._sides[index] = rule.sides

    def finish(self) -> None:
        """Give the walls their materials and sides."""
        self._walls.materials, self._walls.sides = tuple(self._materials), tuple(self._sides)


def named(walls: Walls, layer: str, group: str, name: str) -> list[int]:
    """Find walls by globs on their layer, on any group around them, and on their name."""
    return [
        index
        for index, origin in enumerate(walls.origins)
        if fnmatchcase(walls.layers[index], layer)
        and fnmatchcase(walls.names[index], name)
        and (group == "*" or any(fnmatchcase(one, group) for one in origin.groups))
    ]


def painted(walls: Walls, colour: str) -> list[int]:
    """Find walls by the colour of their fill, or of their stroke where they are not filled; ``#f00`` is ``#ff0000``."""
    wanted = colour.lower()
    if len(wanted) == 4 and wanted.startswith("#"):
        wanted = "#" + "".join(2 * digit for digit in wanted[1:])
    return [index for index, origin in enumerate(walls.origins) if origin.colour == wanted]
