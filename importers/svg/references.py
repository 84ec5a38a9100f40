"""References within the file: targets of ``use``, paint servers, and what nothing refers to."""

from __future__ import annotations

from typing import Any
from urllib.parse import unquote

from importers.limits import MAX_ELEMENTS, MAX_REFERENCES, Work, limit_error
from importers.svg.notes import Notes
from importers.svg.shapes import SHAPES

_XLINK = "{http://www.w3.org/1999/xlink}href"


class References:
    """Ids of a document and the references to them."""

    def __init__(self, root: Any, prefix: str, file: str, work: Work) -> None:
        self._root, self._prefix, self._file, self._work = root, prefix, file, work
        self._ids: dict[str, Any] = {}
        for element in root.xpath("//*[@id]"):
            self._ids.setdefault(element.get("id"), element)
        # Each once, in the order of the walk: defs, symbols and the like that it passed by; children of switch
        self.kept_back: dict[Any, None] = {}
        self.not_chosen: dict[Any, None] = {}
        self._uses = list(root.iter(prefix + "use"))
        if self._uses:
            self._check_size()

    def _href(self, element: Any) -> str | None:
        for name in ("href", _XLINK, "xlink:href"):  # the last where its prefix is not declared
            href = element.get(name)
            if href is not None:
                return str(href)
        return None

    def referred(self, element: Any) -> Any:
        """Give the element of this file that the href of another names, or None."""
        href = (self._href(element) or "").strip()
        if not href.startswith("#"):
            return None
        found = self._ids.get(href[1:])
        return self._ids.get(unquote(href[1:])) if found is None else found

    def target(self, element: Any, chain: tuple[Any, ...]) -> tuple[Any, str]:
        """Give what a ``use`` shows, or None and why it shows nothing."""
        href = self._href(element)
        found = self.referred(element)
        if found is None:
            if href is None:
                return None, "a use without href"
            if not href.strip().startswith("#"):
                return None, f"{href[:60]!r} is in another file, and no other file is read"
            return None, f"there is no element with the id {href.strip()[1:61]!r}"
        if not found.tag.startswith(self._prefix):
            return None, f"{href!r} is not an SVG element"
        if found in chain or any(around is found for around in element.iterancestors()):
            return None, f"{href!r} contains this very use, so it shows nothing"
        return found, ""

    def at(self, address: str) -> Any:
        """Give the element that ``#id`` names, or None."""
        return self._ids.get(address[1:]) if address.startswith("#") else None

    def _check_size(self) -> None:
        """Count what all references together unfold to, each target once: a small file can ask for billions.

        Elements in document order, last first, so that children come before their parents; a target that is
        not yet counted is counted on its own stack.
        """
        sizes: dict[Any, tuple[int, int]] = {}  # element to (references, elements) that its subtree unfolds to
        todo: list[Any] = [self._root]
        open_now: set[Any] = set()
        while todo:
            element = todo[-1]
            if element in sizes:
                todo.pop()
                continue
            parts = [c for c in element.iterchildren("*") if c.tag != self._prefix + "defs" or element is self._root]
            if element.tag == self._prefix + "use":
                target = self.referred(element)
                if target is not None:
                    parts.append(target)
            missing = [part for part in parts if part not in sizes and part not in open_now]
            if missing and element not in open_now:
                open_now.add(element)
                todo.extend(missing)
                continue
            counts = [sizes.get(part, (0, 0)) for part in parts]
            own = 1 if element.tag == self._prefix + "use" else 0
            sizes[element] = (own + sum(c[0] for c in counts), 1 + sum(c[1] for c in counts))
            open_now.discard(element)
            todo.pop()
        references, elements = self._shown(sizes)
        if references > MAX_REFERENCES:
            raise limit_error("references that are followed", f"{MAX_REFERENCES:,}", file=self._file)
        if elements > MAX_ELEMENTS:
            raise limit_error("elements, references followed", f"{MAX_ELEMENTS:,}", file=self._file)

    def _shown(self, sizes: dict[Any, tuple[int, int]]) -> tuple[int, int]:
        return sizes[self._root]

    def report(self, notes: Notes) -> None:
        """Count the shapes that are there only to be referred to, and that nothing does draw."""
        used = {self.referred(use) for use in self._uses}
        shapes = {self._prefix + tag for tag in SHAPES}
        passed: set[Any] = set()
        for element in self.kept_back:
            self._work.charge("elements", 10)
            if element in passed or any(around in used for around in element.iterancestors()):
                continue
            tag = element.tag[len(self._prefix) :]
            message = f"shape in <{tag}> is not drawn by itself"
            todo = [element]
            while todo:  # from the outside in, and not into what a reference shows
                inner = todo.pop()
                if inner in used or inner in passed:
                    continue
                passed.add(inner)
                self._work.charge("elements", 1)
                if inner.tag in shapes:
                    notes.count("not-drawn", "info", message, element)
                todo.extend(inner.iterchildren("*"))
        for element in self.not_chosen:
            notes.count("not-chosen", "info", "child of <switch> is not the one that is shown", element)
