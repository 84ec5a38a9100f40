#!/usr/bin/env bash
# PyTMX 3.32: what a good engineer guesses and what happens.
#
# Input: a map of Tiled 1.12 in which one object has a property of the type "list", new in that version.
# Guess: a reader of older maps leaves out a property that it does not know, perhaps with a warning, and reads the rest.
# What happens: KeyError: 'list', and nothing of the file is read, however many layers it has. So an exporter that wants to
#   be read keeps to the types of 1.10: bool, color, file, float, int, object, string.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pytmx==3.32
cat > level.tmx <<'XML'
<?xml version="1.0" encoding="UTF-8"?>
<map version="1.11" tiledversion="1.12.0" orientation="orthogonal" renderorder="right-down" width="4" height="4"
 tilewidth="32" tileheight="32" infinite="0" nextlayerid="2" nextobjectid="3">
 <objectgroup id="1" name="walls">
  <object id="1" x="0" y="0" width="32" height="32"/>
  <object id="2" x="64" y="0"><properties><property name="gates" type="list"><item type="int" value="3"/></property>
  </properties><polygon points="0,0 32,0 0,32"/></object>
 </objectgroup>
</map>
XML
venv/bin/python -I - <<'PYTHON'
import re
import sys
from importlib.metadata import version
from pathlib import Path

import pytmx

print("PyTMX", version("pytmx"))
try:
    pytmx.TiledMap("level.tmx")
except KeyError as error:
    print("with the list: KeyError", error)
else:
    sys.exit("this has changed")
text = Path("level.tmx").read_text()
Path("older.tmx").write_text(re.sub(r"<properties>.*</properties>", "", text, flags=re.S))
print("without it:", len(list(pytmx.TiledMap("older.tmx").objects)), "objects")
PYTHON
