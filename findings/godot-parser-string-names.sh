#!/usr/bin/env bash
# godot_parser 0.1.7: what a good engineer guesses and what happens.
#
# Input: scene files as Godot 4 saves them, whose nodes have a StringName (&"metal"), a typed array or an infinite
#   number.
# Guess: a parser of Godot's scenes reads them; its version of 2023 came after Godot 4.
# What happens: each is a ParseException that points at the first line of the property and says "Expected end of text".
#   Scenes without these are read and written as they were.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install -q godot_parser==0.1.7 pyparsing==3.2.5
venv/bin/python - <<'PY'
from importlib.metadata import version

from godot_parser import parse


def read(value):
    try:
        parse(f'[gd_scene format=3]\n\n[node name="wall" type="StaticBody2D"]\nmetadata/kind = {value}\n')
    except Exception as error:
        return f"{type(error).__name__}: {str(error)[:38]}"
    return "read"


values = ["PackedVector2Array(0, 1e-05, 3, -4.5)", '&"metal"', "Array[int]([1, 2])", "inf"]
for value in values:
    print(f"godot_parser {version('godot_parser')}: {value}: {read(value)}")
assert read(values[0]) == "read", "this has changed"
assert all(read(value).startswith("ParseException: Expected end of text") for value in values[1:]), "this has changed"
PY
