"""Optional content of a PDF as layers: which of it the file shows, locks and prints."""

from __future__ import annotations

from typing import Any

from importers.drawing import Layer
from importers.pdf.document import Document, get, is_dictionary, items, word


class OptionalContent:
    """What a PDF's catalogue says about its optional-content groups.

    Attributes:
        layers: those that the page uses, in the order of their first use.
    """

    def __init__(self, document: Document) -> None:
        properties = get(document.root, "/OCProperties")
        default = get(properties, "/D")
        self._base_off = word(get(default, "/BaseState")) == "/OFF"
        self._on = {group.objgen for group in items(get(default, "/ON")) if is_dictionary(group)}
        self._off = {group.objgen for group in items(get(default, "/OFF")) if is_dictionary(group)}
        self._locked = {group.objgen for group in items(get(default, "/Locked")) if is_dictionary(group)}
        self._known: dict[tuple[int, int], Layer] = {}
        self.layers: list[Layer] = []

    def layer(self, content: Any) -> Layer | None:
        """Give the layer that a group, or a membership dictionary of groups, stands for; None for neither."""
        if not is_dictionary(content):
            return None
        if word(get(content, "/Type")) != "/OCMD":
            return self._group(content)
        groups = get(content, "/OCGs")
        found = [self._group(groups)] if is_dictionary(groups) else [self._group(group) for group in items(groups)]
        members = [layer for layer in found if layer is not None]
        if not members:
            return None
        shown = [layer.visible for layer in members]
        policy = word(get(content, "/P")) or "/AnyOn"
        visible = {"/AllOn": all(shown), "/AnyOff": not all(shown), "/AllOff": not any(shown)}.get(policy, any(shown))
        return members[0] if members[0].visible == visible else Layer(members[0].name, visible=visible)

    def _group(self, group: Any) -> Layer | None:
        """Give the layer of one group, listed on its first use."""
        if not is_dictionary(group):
            return None
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
