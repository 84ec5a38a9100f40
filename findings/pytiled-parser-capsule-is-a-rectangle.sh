#!/usr/bin/env bash
# pytiled-parser 2.2.9: what a good engineer guesses and what happens.
#
# Input: a map of Tiled 1.12 with a capsule, a kind of object new in that version, and an ellipse.
# Guess: an error or a warning that the capsule is not known.
# What happens: it is a Rectangle as large as the capsule, without a word, so that its round ends are corners. The
#   layer's offset has to be given in both directions: offsetx alone, whose partner Tiled's documents give as 0, is a
#   KeyError.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install -q pytiled-parser==2.2.9
venv/bin/python - <<'PY'
import warnings
from importlib.metadata import version
from pathlib import Path

import pytiled_parser

MAP = """<?xml version="1.0" encoding="UTF-8"?>
<map version="1.11" tiledversion="1.12.0" orientation="orthogonal" renderorder="right-down" width="10" height="10"
 tilewidth="16" tileheight="16" infinite="0" nextlayerid="2" nextobjectid="3">
 <objectgroup id="1" name="walls"OFFSET>
  <object id="1" x="10" y="10" width="20" height="10"><ellipse/></object>
  <object id="2" x="10" y="50" width="20" height="10"><capsule/></object>
 </objectgroup>
</map>
"""


def kinds(offset):
    Path("map.tmx").write_text(MAP.replace("OFFSET", offset), encoding="utf-8")
    return [type(thing).__name__ for thing in pytiled_parser.parse_map(Path("map.tmx")).layers[0].tiled_objects]


warnings.simplefilter("error")
print("pytiled-parser", version("pytiled-parser"), kinds(""))
assert kinds("") == ["Ellipse", "Rectangle"], "this has changed"
try:
    kinds(' offsetx="1"')
except KeyError as error:
    print("offsetx alone: KeyError", error)
else:
    raise SystemExit("this has changed")
PY
