"""Options of an import as small and as large as numbers go: an answer, or an error that names the option."""

import io

import numpy as np
import pytest
import shapely

import wallkit
from wallkit.walls.as_shapely import CHORDS, check_tolerance
from wallkit.walls.checking.self_check import straight_edges

DRAWING = (
    b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><path d="M5 5H95V95H5Z"/>'
    b'<circle cx="50" cy="50" r="10"/></svg>'
)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-12, 1e-100, 5e-324])
def test_arcs_need_no_more_work_for_a_tolerance_that_they_keep_anyway(tolerance):
    walls = wallkit.import_walls(io.BytesIO(DRAWING), tolerance=tolerance, curves="arcs")
    assert len(walls.vertices) == 8
    edges = straight_edges(walls)
    assert len(edges) <= CHORDS + len(walls.vertices)
    # the farthest point of a chord is its middle; shapely measures it from the circle's centre
    middle = shapely.points((edges.a + edges.b)[edges.wall == 1] / 2)
    least = shapely.distance(middle, shapely.Point(50, 50)).min()
    assert 10 - least <= check_tolerance(walls, walls.tolerance) + 1e-14


def test_lines_in_the_place_of_arcs_are_limited():
    walls = wallkit.import_walls(io.BytesIO(DRAWING), curves="arcs")
    for tolerance in (1e-15, 1e-100, 5e-324):
        with pytest.raises(wallkit.WallkitError, match="lines in the place of arcs, at most 2,000,000"):
            walls.straightened(tolerance)


@pytest.mark.parametrize("curves", ["lines", "arcs"])
@pytest.mark.parametrize(
    "wishes",
    [
        {"scale": 1e308},
        {"scale": 1e20},
        {"origin": "10,1e308"},
        {"origin": "-1e10,0"},
        {"units": "1m=1e-300px"},
        {"units": "1e300m=1px", "scale": 1e300},
        {"min_width": 1e308},
        {"snap": 1e10},
        {"grid": 1e10},
        {"simplify": 1e10},
    ],
)
def test_what_no_coordinate_reaches_is_refused_by_name(wishes, curves):
    (name, *_) = wishes
    with pytest.raises(wallkit.WallkitError) as caught:
        wallkit.import_walls(io.BytesIO(DRAWING), curves=curves, **wishes)
    assert caught.value.code == "bad-option"
    assert name in str(caught.value)


@pytest.mark.parametrize("wishes", [{"scale": 1e7}, {"origin": "-9e8,0"}, {"units": "1m=1000px"}, {"scale": 1e-300}])
def test_what_coordinates_reach_is_made(wishes):
    walls = wallkit.import_walls(io.BytesIO(DRAWING), **wishes)
    assert np.isfinite(walls.vertices).all()
    assert np.abs(walls.vertices).max() <= 1e9


@pytest.mark.parametrize("grid", [5e-324, 1e-300, 1e-20, 2.0**-52])
def test_a_grid_finer_than_doubles_moves_nothing(grid):
    plain = wallkit.import_walls(io.BytesIO(DRAWING))
    snapped = wallkit.import_walls(io.BytesIO(DRAWING), grid=grid)
    assert np.abs(snapped.vertices - plain.vertices).max() <= grid
