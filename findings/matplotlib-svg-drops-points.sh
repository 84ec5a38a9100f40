#!/usr/bin/env bash
# matplotlib 3.10.8: what a good engineer guesses and what happens.
#
# Input: a circle as a line through 721 points, saved as SVG.
# Guess: a vector format holds the points that were plotted, 720 segments.
# What happens: 181 segments. A line of 128 points and more is thinned to a ninth of a pixel before it is written, and
#   rcParams["path.simplify"] = False set after plotting changes nothing; it must be set before the line is made.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install -q matplotlib==3.10.8 numpy==2.4.6
venv/bin/python - <<'PY'
import re

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import numpy as np

turn = np.linspace(0.0, 2.0 * np.pi, 721)


def plotted():
    figure = plt.figure()
    axes = figure.add_axes([0, 0, 1, 1])
    axes.plot(np.cos(turn), np.sin(turn))
    axes.axis("off")
    return figure


def segments(figure):
    figure.savefig("circle.svg")
    return max(data.count("L") for data in re.findall(r' d="([^"]*)"', open("circle.svg").read()))


figure = plotted()
usual = segments(figure)
matplotlib.rcParams["path.simplify"] = False
late, early = segments(figure), segments(plotted())
print(f"matplotlib {matplotlib.__version__}: {usual} segments, {late} if switched off late, {early} if before, of 720")
assert usual == late < 360 and early == 720, "this has changed"
PY
