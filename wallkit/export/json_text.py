"""JSON with a line for each wall, so that people can look into it and diff it; numbers as repr."""

from __future__ import annotations

import json
from typing import Any


def spread(value: Any, depth: int, indent: int = 0) -> str:
    """Write JSON: the outer ``depth`` levels one entry a line, what is deeper on one line."""
    if depth == 0 or not isinstance(value, dict | list) or not value:
        return json.dumps(value, ensure_ascii=False, allow_nan=False)
    pad = "\n" + " " * (indent + 1)
    if isinstance(value, dict):
        lines = [
            f"{json.dumps(key, ensure_ascii=False)}: {spread(v, depth - 1, indent + 1)}" for key, v in value.items()
        ]
        return "{" + pad + ("," + pad).join(lines) + "\n" + " " * indent + "}"
    return "[" + pad + ("," + pad).join(spread(v, depth - 1, indent + 1) for v in value) + "\n" + " " * indent + "]"


def points(vertices: Any) -> list[dict[str, float]]:
    """Give (n, 2) points as JSON has them in most engines: a list of x and y."""
    return [{"x": x, "y": y} for x, y in vertices.tolist()]
