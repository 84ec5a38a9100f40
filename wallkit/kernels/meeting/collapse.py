"""Clusters whose contacts come ever faster: what they lose is lost up to rounding, and then no more.

With restitution e < 1 discs may meet infinitely often in a finite time (McNamara and Young 1994, Phys. Rev. E 50:R28).
Once the contacts of a disc with others pass neither time nor space beyond rounding, STILL_LIMIT of them in a row, they
are made without loss: of such contacts there are finitely many, and the cluster goes on.
"""

from __future__ import annotations

from wallkit.kernels.jit import kernel
from wallkit.kernels.meeting.pair_impact import begins, meeting_time
from wallkit.kernels.meeting.records import STILL, TIME, TOLERANCE, VX, VY

STILL_LIMIT = 100
"""Contacts in a row that rounding does not tell apart, after which contacts with other discs lose nothing."""


@kernel
def is_caught(gravity, discs, restitution, one, two):
    """Count a contact of two discs that is about to be made, and tell whether one of them is caught in a cluster."""
    if restitution is None:
        return False
    first, second = begins(discs.ball[one], discs.ball[two])
    _due, t = meeting_time(gravity, discs.ball[one], discs.ball[two])
    return max(count_still(discs, one, first + t), count_still(discs, two, second + t)) > STILL_LIMIT


@kernel
def count_still(discs, ball, t):
    """Count a contact of a disc, t after its last one: how many in a row pass neither time nor space."""
    row, cold = discs.ball[ball], discs.cold[ball]
    time = row[TIME]
    moves = time + t > time and t * (abs(row[VX]) + abs(row[VY])) > cold[TOLERANCE] * 2.0**-6
    still = 0.0 if moves else cold[STILL] + 1.0
    cold[STILL] = still
    return still
