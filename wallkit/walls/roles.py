"""Roles: what a layer, a group or a ``data-*`` tag makes of a path. The table says it once, for everybody who asks.

The nearest word decides: the path's own tag ``data-role``, then the groups around it from the innermost out, then its
layer. A path that nothing speaks of is a wall.
"""

from __future__ import annotations

from typing import Literal, get_args

from importers.drawing import DrawnPath

Role = Literal["wall", "ball"]
"""A ball is a circle, with a line from its centre as its velocity."""

ROLE_TAG = "role"
BALLS_LAYER = "balls"

_BY_NAME: dict[str, Role] = {BALLS_LAYER: "ball"}
"""Names of layers and groups that make something of what is in them."""
_BY_TAG: dict[str, Role] = {role: role for role in get_args(Role)}
"""Values of the tag ``data-role``."""


def role_of(path: DrawnPath) -> Role:
    """Tell what a path is."""
    tagged = _BY_TAG.get(path.tags.get(ROLE_TAG, ""))
    if tagged:
        return tagged
    named = (_BY_NAME.get(name) for name in (*reversed(path.groups), path.layer))
    return next((role for role in named if role), "wall")
