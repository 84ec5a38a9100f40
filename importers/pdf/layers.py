"""Optional content of a PDF as layers: which of it the file shows, locks and prints."""

from __future__ import annotations

from typing import Any

from importers.drawing import Layer
from importers.limits import limit_error
from importers.pdf.document import Document, get, is_dictionary, items, word

_MAX_GROUPS = 100_000  # looked at
_MAX_EXPRESSIONS = 32  # visibility expressions in each other; programs write two or three


class OptionalContent:
    """What a PDF's catalogue says about its optional-content groups.

    Attributes:
        layers: those that the page uses, in the order of their first use.
    """

    def __init__(self, document: Document) -> None:
        properties = get(document.root, "/OCProperties")
        default = get(properties, "/D")
        self._base_off = word(get(default, "/BaseState")) == "/OFF"
        self._document = document
        self._on, self._off, self._locked = (self._listed(get(default, key)) for key in ("/ON", "/OFF", "/Locked"))
        self._known: dict[tuple[int, int], Layer] = {}
        self._memberships: dict[tuple[int, int], Layer | None] = {}
        self.layers: list[Layer] = []

    def _listed(self, array: Any) -> set[tuple[int, int]]:
        """Give the groups that an array lists."""
        found = set()
        for group in items(array):
            self._document.follow("groups of optional content of a PDF", _MAX_GROUPS)
            if is_dictionary(group):
                found.add(group.objgen)
        return found

    def layer(self, content: Any) -> Layer | None:
        """Give the layer that a group, or a membership dictionary of groups, stands for; None for neither.

        Raises:
            LimitError: a visibility expression is too deep, or too many groups were looked at.
        """
        if not is_dictionary(content):
            return None
        if word(get(content, "/Type")) != "/OCMD":
            return self._group(content)
        key = content.objgen
        if key == (0, 0) or key not in self._memberships:
            self._memberships[key] = self._membership(content)
        return self._memberships[key]

    def _membership(self, content: Any) -> Layer | None:
        """Give the layer of a membership dictionary: named as its first group, shown as its rule has it."""
        groups = get(content, "/OCGs")
        found = [self._group(groups)] if is_dictionary(groups) else [self._group(group) for group in items(groups)]
        members = [layer for layer in found if layer is not None]
        expression = get(content, "/VE")
        if expression is not None:
            shown = self._is_shown(expression, members, 0)
        elif members:
            on = [layer.visible for layer in members]
            rules = {"/AllOn": all(on), "/AnyOff": not all(on), "/AllOff": not any(on)}
            shown = rules.get(word(get(content, "/P")), any(on))
        else:
            return None
        if not members:
            return Layer("", visible=shown)
        return members[0] if members[0].visible == shown else Layer(members[0].name, visible=shown)

    def _is_shown(self, expression: Any, members: list[Layer], depth: int) -> bool:
        """Work out a visibility expression: a group, or an array of And, Or or Not and what it joins.

        Args:
            expression: the expression.
            members: the groups met so far.
            depth: how many expressions are around it.
        """
        self._document.follow("groups in visibility expressions of a PDF", _MAX_GROUPS)
        if depth > _MAX_EXPRESSIONS:
            raise limit_error("visibility expressions in each other", str(_MAX_EXPRESSIONS), file=self._document.file)
        if is_dictionary(expression):
            layer = self._group(expression)
            members += [layer] if layer is not None else []
            return layer is None or layer.visible
        parts = items(expression)
        operator = word(next(parts, None))
        shown = [self._is_shown(part, members, depth + 1) for part in parts]
        rules = {"/And": all(shown), "/Or": any(shown), "/Not": not all(shown)}
        return rules.get(operator, True)

    def _group(self, group: Any) -> Layer | None:
        """Give the layer of one group, listed on its first use."""
        if not is_dictionary(group):
            return None
        self._document.follow("groups of optional content of a PDF", _MAX_GROUPS)
        key = group.objgen
        layer = self._known.get(key) if key != (0, 0) else None
        if layer is None:
            off = key in self._off or (self._base_off and key not in self._on)
            print_state = word(get(get(get(group, "/Usage"), "/Print"), "/PrintState"))
            layer = Layer(
                " ".join(word(get(group, "/Name")).split()),
                visible=not off,
                locked=key in self._locked,
                printing=print_state != "/OFF",
            )
            self._known[key] = layer
            self.layers.append(layer)
        return layer
