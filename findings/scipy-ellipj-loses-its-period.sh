#!/usr/bin/env bash
# scipy 1.17.1: what a good engineer guesses and what happens.
#
# Input: scipy.special.ellipj(u, m) at u = 1, 1.5, 2 and 3 quarter periods K, with m = 1 - 1e-8 and m = 1 - 1e-10: a pendulum that
#   almost stands on its head.
# Guess: sn is 1, a little less, 0 and -1: a function of period 4 K, as the manual says.
# What happens: so it is for the first m. For the second sn stays at 1 for ever, above it by 2.5e-11: the pendulum goes up and
#   never comes down, and the square root of 1 - sn**2 is no number. m within 1e-9 of 1 is put through a series in 1 - m that
#   holds for the first quarter only; the last of the manual's notes says that it does, and no warning comes.
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check scipy==1.17.1 numpy==2.3.5 mpmath==1.3.0
venv/bin/python -I - <<'PYTHON'
import sys
from importlib.metadata import version

import mpmath
from scipy.special import ellipj, ellipkm1

print("scipy", version("scipy"))
changed = False
for short_of_one, holds in ((1e-8, True), (1e-10, False)):
    m = 1 - short_of_one
    quarter = float(mpmath.ellipk(m))
    assert abs(ellipkm1(1 - m) - quarter) < 1e-12 * quarter
    for quarters in (1, 1.5, 2, 3):
        told = float(ellipj(quarters * quarter, m)[0])
        right = float(mpmath.ellipfun("sn", quarters * quarter, m=m).real)
        print(f"m = 1 - {short_of_one}, u = {quarters} K: {told:.14f}, mpmath {right:.14f}")
        changed |= (abs(told - right) > 0.9) != (not holds and quarters >= 2)
        changed |= (told > 1 + 1e-12) != (not holds)
sys.exit(int(changed))  # 1: this has changed
PYTHON
