"""What a scene file says about walls: by their colour, layer, group and name.

What a drawing says of its own walls goes before it.
A rule is one table of ``[colours]`` or ``[[materials]]``: those by colour first, then the others in the file's order,
the last that fits winning key by key. A word in the drawing (docs/tags.md) goes before them all.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from importers.drawing import Drawing, DrawnPath, Level
from importers.limits import Work
from wallkit.globs import fits, steps_of
from wallkit.walls import Material, Walls
from wallkit.walls.fields import Sides
from wallkit.walls.roles import levels_of, material_keys_of, plain_name, sides_of
from wallkit.walls.tags import MATERIAL_KEYS

RULE_KEYS = (*MATERIAL_KEYS, "sides", "role")
FIT_KEYS = ("layer", "group", "wall")
MATCHING = "rules matched with walls"


@dataclass(frozen=True, slots=True)
class Rule:
    """What is said of the walls that fit; None where nothing is."""

    restitution: float | None = None
    tangential_restitution: float | None = None
    static_friction: float | None = None
    sides: Sides | None = None


class Ruled:
    """Walls while rules are applied to them.

    Attributes:
        steps: of work that it takes to find those that one rule fits.
    """

    def __init__(self, walls: Walls) -> None:
        self._walls = walls
        groups = (word for origin in walls.origins for word in origin.groups)
        self.steps = steps_of(walls.layers) + steps_of(walls.names) + steps_of(groups)
        self._materials = list(walls.materials)
        self._sides = list(walls.sides)

    def apply(self, rule: Rule, walls: Iterable[int]) -> None:
        """Let a rule hold for walls, but for what their tags say."""
        said = {key: getattr(rule, key) for key in MATERIAL_KEYS if getattr(rule, key) is not None}
        made: dict[tuple[Material, frozenset[str]], Material] = {}
        for index in walls:
            tags, before = self._walls.origins[index].tags, self._materials[index]
            own = frozenset(material_keys_of(tags)) if tags else frozenset()
            if (before, own) not in made:
                made[before, own] = replace(before, **{key: said[key] for key in said if key not in own})
            self._materials[index] = made[before, own]
            if rule.sides is not None and sides_of(tags) is None:
                self._sides[index] = rule.sides

    def finish(self) -> None:
        """Give the walls their materials and sides."""
        self._walls.materials, self._walls.sides = tuple(self._materials), tuple(self._sides)


@dataclass(frozen=True, slots=True)
class Fit:
    """What a table speaks of: globs on layer, any group around, and name; or a colour.

    The colour is that of the fill, or of the stroke where there is no fill; ``#f00`` is ``#ff0000``.
    """

    layer: str = "*"
    group: str = "*"
    wall: str = "*"
    colour: str | None = None

    def walls(self, walls: Walls) -> list[int]:
        """Find the walls that fit."""
        rows = zip(walls.layers, walls.origins, walls.names, strict=True)
        return [
            index
            for index, (layer, origin, name) in enumerate(rows)
            if self._takes(layer, origin.groups, name, origin.colour)
        ]

    def paths(self, drawing: Drawing) -> list[int]:
        """Find the paths of a drawing that fit, by their names without words."""
        return [index for index, path in enumerate(drawing.paths) if self._takes_path(path)]

    def _takes_path(self, path: DrawnPath) -> bool:
        colour = path.fill if path.fill is not None else path.stroke
        return self._takes(plain_name(path.layer), tuple(map(plain_name, path.groups)), plain_name(path.name), colour)

    def _takes(self, layer: str, groups: tuple[str, ...], name: str, colour: str | None) -> bool:
        if self.colour is not None:
            return colour == _six_digits(self.colour)
        return (
            fits(layer, self.layer)
            and fits(name, self.wall)
            and (self.group == "*" or any(fits(one, self.group) for one in groups))
        )


def _six_digits(colour: str) -> str:
    wanted = colour.lower()
    if len(wanted) == 4 and wanted.startswith("#"):
        wanted = "#" + "".join(2 * digit for digit in wanted[1:])
    return wanted


def say_roles(drawing: Drawing, roles: Iterable[tuple[Fit, str]], work: Work) -> None:
    """Let paths of a drawing be what a scene file says (``sensor``, ``target:left`` ...), the last that fits winning.

    It is said of them as of a layer around all others, so that every word in the drawing goes before it.
    """
    said: dict[int, str] = {}
    steps = steps_of(word for path in drawing.paths for word in (path.layer, path.name, *path.groups))
    for fit, role in roles:
        work.charge(MATCHING, steps)
        said |= dict.fromkeys(fit.paths(drawing), role)
    for index, role in said.items():
        path = drawing.paths[index]
        word, _, name = role.partition(":")
        path.levels = (Level("layer", "", {word: name}), *levels_of(path))
