import subprocess
import sys
import xml.etree.ElementTree as ET

import pytest

import wallkit
from importers.drawing import Drawing, DrawnPath, Subpath

WALLS = wallkit.Walls.from_polylines([[(0, 0), (10, 0), (10, 7), (0, 7)]])
SCENE = wallkit.Scene(WALLS, wallkit.Balls([[3, 3]], [[1.0, 2]], 1))


@pytest.mark.parametrize(
    "thing",
    [
        Drawing("pt", "up", paths=[DrawnPath([Subpath([("M", 0, 0), ("L", 5, 5)], closed=False)])]),
        WALLS,
        SCENE,
        wallkit.simulate(SCENE, bounces=5),
    ],
    ids=lambda thing: type(thing).__name__,
)
def test_a_notebook_shows_it_as_svg(thing):
    assert ET.fromstring(thing._repr_svg_()).tag == "{http://www.w3.org/2000/svg}svg"


def test_the_importers_alone_know_no_painter():
    script = (
        "import sys\nfrom importers.drawing import Drawing\n"
        "print(Drawing('pt', 'up')._repr_svg_(), 'wallkit' in sys.modules)"
    )
    said = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert said.stdout == "None False\n"
