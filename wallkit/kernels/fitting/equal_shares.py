"""Cuts at equal shares of the error of earlier spans; ``walls.importing.arc_fitting.cuts`` says what for."""

from __future__ import annotations

from wallkit.kernels.fitting.cubic_chains import point_at
from wallkit.kernels.jit import kernel

PARTS = 2.0**20
"""Shares are whole numbers of these, so that sums are exact."""
ROUNDING = 1.5 * 2.0**52
"""A number below 2^51 that this is added to and taken from is rounded to a whole one, as by rint."""


@kernel
def share_out(chains, old, shares, counts, new):
    """Write where stretches are cut into spans of equal shares; within an old span shares grow evenly.

    Args:
        chains: of cubics.
        old: stretch (rising), low, high and share of each old span.
        shares: chain and stretch of each stretch that is cut, rising.
        counts: into how many spans each is cut.
        new: low, high, first and last point of each new span: those of all of its stretch; the inner ones are written.
    """
    stretch, low, high, share = old
    chain, wanted = shares
    new_low, new_high, p0, p1 = new
    last = row = 0
    for n in range(len(wanted)):
        at = last
        while stretch[at] != wanted[n]:
            at += 1
        last, total = at, 0.0
        while last < len(stretch) and stretch[last] == wanted[n]:
            total += share[last]
            last += 1
        reached = share[at]
        for k in range(1, counts[n]):
            target = ((total * k / counts[n]) * PARTS + ROUNDING - ROUNDING) / PARTS
            while reached < target and at < last - 1:
                at += 1
                reached += share[at]
            part = min(max(1.0 - (reached - target) / share[at], 0.0), 1.0)
            cut = low[at] + part * (high[at] - low[at])
            place, _ = point_at(chains, chain[n], cut)
            new_high[row], p1[row] = cut, place
            row += 1
            new_low[row], p0[row] = cut, place
        row += 1
