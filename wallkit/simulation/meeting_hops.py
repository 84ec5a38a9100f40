"""Hops of discs that meet under gravity: how fast they are, and what becomes of errors there."""

from __future__ import annotations

import math

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.scene.scene import Scene

HOP = 2.0**-12
"""By this part of the radius of the smallest disc a disc under gravity hops off what it would come to lie on."""


def hop_speed(scene: Scene, radii: FloatArray) -> float:
    """Speed at which the smallest disc rises by ``HOP`` of its radius: v^2 = 2 g h; 0 without gravity or discs."""
    pull = math.hypot(*scene.gravity) if scene.gravity is not None else 0.0
    return math.sqrt(2.0 * pull * HOP * float(radii.min())) if len(radii) else 0.0


def turned_errors(
    kept: tuple[FloatArray, FloatArray], hop: float, closing: FloatArray, c: FloatArray, n: FloatArray,
    errors: tuple[FloatArray, FloatArray],
) -> FloatArray:  # fmt: skip
    """Errors (k, m, 2) of the relative velocity W' after a contact, to first order.

    W' = S n + f (W - (W.n) n) with S = -e W.n, or the speed of a hop where that is more and e < 1. So, with
    c = d(W.n) = dW.n + W.dn, dW' = S dn + dS n + f (dW - c n - (W.n) dn), and dS = -e c, or 0 for a hop.

    Args:
        kept: (k, 1, 1) or numbers: e and f.
        hop: speed of a hop; 0 for none.
        closing: (k, 1) W.n, below 0.
        c: (k, m) its error.
        n: (k, 1, 2) unit normal.
        errors: (k, m, 2) dW and dn.
    """
    e, f = kept
    dw, dn = errors
    parting = -e * closing[..., None]
    hops = (parting < hop) & (np.asarray(e) < 1.0)
    along = f + np.where(hops, 0.0, e)
    across = np.where(hops, hop, parting) - f * closing[..., None]
    found: FloatArray = f * dw - along * c[..., None] * n + across * dn
    return found
