"""Warmth: kernels are compiled behind the page's back, so that aiming never waits for a compiler."""

from __future__ import annotations

import threading
from dataclasses import replace
from typing import Literal

import numpy as np

from wallkit.scene.scene import Balls, Scene

Key = tuple[bool, ...]
_SMALL = 20_000  # edges; interpreting a few bounces among more takes longer than a person likes to wait


class Warmth:
    """Knows for which kinds of scene the kernels are compiled already.

    Numba compiles once for each set of features that a scene has (and finds it on disk later). The first question
    about a kind starts that in a thread of its own; until it is done, runs are interpreted, which gives the same
    bits, and kept short.
    """

    def __init__(self) -> None:
        self._begun: set[Key] = set()
        self._ready: set[Key] = set()
        self._lock = threading.Lock()

    def mode(self, scene: Scene) -> Literal["auto", "interpreted"]:
        """Say how to simulate a scene now."""
        key = _kind(scene)
        if key in self._ready or not len(scene.balls):
            return "auto"
        with self._lock:
            if key not in self._begun:
                self._begun.add(key)
                threading.Thread(target=self._compile, args=(scene, key), daemon=True).start()
        return "interpreted" if len(scene.walls.vertices) <= _SMALL else "auto"

    def _compile(self, scene: Scene, key: Key) -> None:
        from wallkit.simulation.simulate import simulate

        first = Balls(
            *(np.asarray(part)[:1] for part in (scene.balls.position, scene.balls.velocity, scene.balls.radius))
        )
        try:
            simulate(replace(scene, balls=first), bounces=1, mode="compiled")
        except Exception:  # the question itself will hear of what is wrong with the scene
            with self._lock:
                self._begun.discard(key)
        else:
            self._ready.add(key)


def _kind(scene: Scene) -> Key:
    walls = scene.walls
    return (
        walls.has_arcs,
        scene.gravity is not None,
        any(m.restitution < 1.0 or m.tangential_restitution < 1.0 for m in set(walls.materials)),
        "outward" in walls.sides,
        bool(np.any(np.asarray(scene.balls.radius) > 0.0)),
        len(walls.vertices) > 16,
    )
