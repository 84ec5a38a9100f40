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
    drawn = ET.fromstring(thing.to_svg(title="Seen", width=333))
    assert drawn.get("width") == "333"
    assert "Seen" in "".join(drawn.itertext())


def test_the_importers_alone_know_no_painter():
    script = (
        "import sys\nfrom importers.drawing import Drawing\n"
        "print(Drawing('pt', 'up')._repr_svg_(), 'wallkit' in sys.modules)"
    )
    said = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert said.stdout == "None False\n"


def test_to_svg_without_a_painter_is_an_error_that_says_what_to_do():
    script = (
        "from importers.drawing import Drawing\nfrom importers.errors import WallkitError\n"
        "try:\n    Drawing('pt', 'up').to_svg()\nexcept WallkitError as error:\n    print(error.code, error.fix)"
    )
    said = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert said.stdout == "no-painter import wallkit\n"
