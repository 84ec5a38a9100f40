#!/usr/bin/env bash
# pooltool-billiards 0.3.3: what a good engineer guesses and what happens.
#
# Input: a ball at 7 m/s, shot at another one 1.25 m away, dead centre, on a table without pockets, whose cloth has a friction
#   (of sliding and of rolling) of 0.2, 0.01, 0.001, 0.0001 and 0.
# Guess: less friction, less change: they meet after 0.175 s with 0.2, after 0.170 s with the least, and with 0 as well
#   (get_slide_time and get_roll_time have a line of their own for a friction of 0).
# What happens: at 0.001 and 0.0001 the ball flies through the other one as if nothing stood there, and meets the cushion behind
#   it; at 0 simulate ends in a ValueError. The roots of the quartic are taken in closed form and are wrong where its first
#   coefficients are small against the others; with quartic_solver=NUMERIC the balls meet (0 is a LinAlgError then).
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pooltool-billiards==0.3.3
venv/bin/python -I - <<'PYTHON'
import sys
import warnings
from importlib.metadata import version

warnings.simplefilter("ignore")
import pooltool
from pooltool.objects.table.specs import BilliardTableSpecs
from pooltool.ptmath.roots.quartic import QuarticSolver

print("pooltool-billiards", version("pooltool-billiards"))


def first(friction: float, solver: QuarticSolver) -> str:
    cloth = {"u_s": friction, "u_r": friction, "u_sp_proportionality": 0.0}
    shot = pooltool.Ball.create("shot", xy=(0.5, 0.5), **cloth)
    aim = pooltool.Ball.create("aim", xy=(0.5, 1.75), **cloth)
    shot.state.rvw[1] = (0.0, 7.0, 0.0)
    shot.state.s = pooltool.constants.sliding
    table = pooltool.Table.from_table_specs(BilliardTableSpecs(l=2.54, w=1.27))
    system = pooltool.System(cue=pooltool.Cue(cue_ball_id="shot"), table=table, balls={"shot": shot, "aim": aim})
    try:
        done = pooltool.simulate(system, t_final=0.2, quartic_solver=solver)
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    event = done.events[1]
    return f"{event.event_type} at {event.time:.4f} s"


found = {}
for friction in (0.2, 0.01, 1e-3, 1e-4, 0.0):
    found[friction] = first(friction, QuarticSolver.HYBRID)
    print(f"friction {friction:g}: {found[friction]}; numeric roots: {first(friction, QuarticSolver.NUMERIC)}")
lost = all("cushion" in found[friction] for friction in (1e-3, 1e-4)) and "Error" in found[0.0]
sys.exit(int(not lost))  # 1: this has changed
PYTHON
