"""The grammars of scene files and of walls in JSON."""

from growing import Grammar

_NUMBERS: Grammar = {
    "n": ["1", "0", "-2.5", "1e-300", "1e300", "1e999", "1{digit*}", "-1", "true", '"a"', "null", "0.1", "[{n*}]", "2"],
    "digit": ["0", "9"],
    "text": ["a", " ", "\\u00e9", "\\n", "b§", "*", "?", "[a]"],
    "point": ["[0,0]", "[{n},{n}]", "[§,1.5]", "[1.5,§]", "[{n*}]"],
    "comma": [",[0,1]", ",{point}", ",[§,¤]", ",[1,§]"],
    "string": ['"a"', '"{text*}"', "1"],
}
_WALLS: Grammar = {
    "wall": [
        '«"closed":true,"vertices":[[0,0],[1,0]{comma*}]»',
        '«"closed":{flag},"vertices":[{point}{comma*}]{key*}»',
        '«"closed":true,"vertices":[[§,0],[¤,0],[¤,1]],"name":{string}»',
        "«»",
        "{n}",
    ],
    "flag": ["true", "false", "{n}"],
    "key": [
        ',"depth":{n}',
        ',"bulges":[0{bulge*}]',
        ',"sides":"outward"',
        ',"material":«"restitution":{n}»',
        ',"name":{string}',
        ',"layer":{string}',
        ',"normals":[{n}]',
        ',"tags":«"{text*}":{string}»',
        ',"groups":[{string}{strings*}]',
        ',"{text*}":{n}',
    ],
    "strings": [",{string}"],
    "bulge": [",0", ",1", ",{n}", ",-0.5"],
    "walls": ["{wall}{next*}"],
    "next": [",{wall}", ',«"closed":true,"vertices":[[§,0],[¤,0],[¤,1]],"layer":"a§"»'],
}
WALLS: Grammar = (
    _NUMBERS
    | _WALLS
    | {
        "file": [
            '«"format":"wallkit-walls","version":1,"walls":[{walls}]»',
            '«"format":"wallkit-walls","version":1,{more*}"walls":[{walls}]»',
            '«"format":"wallkit-walls","version":1,"sensors":[{walls}],"walls":[]»',
        ],
        "more": [
            '"tolerance":{n},',
            '"measured_error":{n},',
            '"units":{string},',
            '"source":«"file":{string}»,',
            '"problems":[{problem}],',
            '"solid":«"room":{flag},"how":"told","why":{string}»,',
            '"markers":[{n}],',
        ],
        "problem": ["", '«"code":"a","severity":"error","message":{string},"fix":"","x":{n},"line":{n}»'],
    }
)
SCENE: Grammar = (
    _NUMBERS
    | _WALLS
    | {
        "file": [
            '«"walls":[{walls}]{part*}»',
            "{toml*}[[walls]]\nclosed=true\nvertices=[[0,0],[9,0],[9,9]{comma*}]\n{tables*}",
            "{toml*}",
            '«"format":"wallkit-run","scene":«"walls":[{walls}]{part*}»»',
        ],
        "part": [
            ',"gravity":[0,{n}]',
            ',"gravity":{n}',
            ',"run":«"until":{n},"bounces":{n}»',
            ',"balls":[{ball}{balls*}]',
            ',"sensors":[{walls}]',
            ',"sensors":["{text*}"{strings*}]',
            ',"materials":[{rule}{rules*}]',
            ',"colours":«"#f00":«"restitution":{n}»,"{text*}":{n}»',
            ',"rolling_friction":{n}',
            ',"drag":{n}',
            ',"{text*}":{n}',
            ',"import":«"tolerance":{n}»',
            ',"drawing":{string}',
            ',"meeting":{flag}',
            ',"ball_restitution":{n}',
            ',"y_axis":"down"',
            ',"lesson":«"title":{string},"way":"stop","dt":{n}»',
        ],
        "ball": ['«"position":{point},"velocity":{point}»', '«"position":{point},"radius":{n},"mass":{n}»'],
        "balls": [",{ball}", ',«"position":[§,§],"velocity":[1,0]»'],
        "rule": [
            '«"layer":"{text*}","restitution":{n}»',
            '«"wall":"*{text*}*a","sides":"outward"»',
            '«"group":"{text*}"»',
        ],
        "rules": [",{rule}"],
        "toml": [
            "[run]\nuntil = {n}\n",
            "gravity = [0, {n}]\n",
            "a§ = {n}\n",
            "a{dotted*} = 1\n",
            "[a{dotted*}]\n",
            "[[a{dotted*}]]\n",
            "a = {deep*}\n",
            "[[balls]]\nposition = [{n}, {n}]\n",
            "[[materials]]\nlayer = '{text*}'\nrestitution = 0.5\n",
            "# {text*}\n",
            "a = '''{text*}\n",
            "a = «{inline*}»\n",
            "a§ = 2020-01-01T00:00:00\n",
            "walls = [«vertices=[[0,0],[1,0]{comma*}]»]\n",
            "\n",
        ],
        "tables": [
            "[[walls]]\nvertices=[[§,0],[¤,0]{comma*}]\nlayer='a§'\n",
            "[[balls]]\nposition = [{n}, {n}]\n",
            "[[materials]]\nlayer = '{text*}'\nrestitution = 0.5\n",
            "[a{dotted*}]\n",
        ],
        "dotted": [".a", ".b§", " . 'x'"],
        "deep": ["[", "«a=", "{n}"],
        "inline": ["a§=1,", "b={n},", "a{dotted*}=1,"],
    }
)
