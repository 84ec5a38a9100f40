"""How far walls are and how triangles hang together: by kernels, compiled and not, beside shapely and scipy."""

import numpy as np
import pytest
import scipy.sparse
import shapely
from scipy.sparse import csgraph

from wallkit.geometry.triangulation import triangulate
from wallkit.walls.checking import rooms_by_kernels, wall_distance
from wallkit.walls.checking.narrow_places import with_feet
from wallkit.walls.checking.triangle_circles import triangle_circles
from wallkit.walls.checking.widest_ways import Ways, unite, ways_out


def sticks(seed, count):
    """Triangles between short lines that keep apart."""
    random = np.random.default_rng(seed)
    middle = 100.0 * np.stack(np.divmod(np.arange(count), 12), axis=1)
    a, b = middle + random.uniform(-45, 45, (2, count, 2))
    mesh = triangulate(a, b)
    assert mesh is not None
    return with_feet(mesh)


def inner_places(mesh):
    inner = np.flatnonzero((mesh.corners < len(mesh.points) - 4).all(axis=1))
    weights = np.random.default_rng(0).dirichlet([1, 1, 1], len(inner))
    return inner, (mesh.points[mesh.corners[inner]] * weights[:, :, None]).sum(axis=1)


@pytest.fixture(params=["compiled", "interpreted"])
def kernels(request, monkeypatch):
    """Let kernels do it, however few triangles there are."""
    for module in (wall_distance, rooms_by_kernels):
        monkeypatch.setattr(module, "kernels_pay", lambda mesh: True)
    if request.param == "interpreted":
        monkeypatch.setattr(rooms_by_kernels, "compiled", lambda kernel: kernel)


def by_numpy(mesh, *places):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(wall_distance, "kernels_pay", lambda mesh: False)
        return wall_distance.wall_distance(mesh, *places)


@pytest.mark.parametrize("seed", range(4))
def test_the_nearest_wall_by_a_kernel_has_the_bits_of_numpy_and_is_shapelys(seed, kernels):
    mesh = sticks(seed, 100)
    places = inner_places(mesh)
    found = wall_distance.wall_distance(mesh, *places)
    walls = shapely.multilinestrings(shapely.linestrings(mesh.points[mesh.ends[mesh.wall]]))
    assert found.tobytes() == by_numpy(mesh, *places).tobytes()
    assert found == pytest.approx(shapely.distance(shapely.points(places[1]), walls), rel=1e-9, abs=1e-10)


def hanging_together(seed):
    mesh = sticks(seed, 60)
    every = np.ones(len(mesh.corners), dtype=np.bool_)
    circle, _ = triangle_circles(mesh, 1e-6, every)
    ways = Ways.of(mesh, circle, every)
    joined = unite(mesh, ways, circle, 1.0, 1e-6)
    return mesh, ways, circle, joined, ways_out(mesh, ways, joined.used)


@pytest.mark.parametrize("seed", range(3))
def test_uniting_by_kernels_finds_what_lists_find(seed, kernels):
    *_, by_kernel, out = hanging_together(seed)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rooms_by_kernels, "kernels_pay", lambda mesh: False)
        *_, by_lists, out_by_lists = hanging_together(seed)
    assert np.array_equal(by_kernel.used, by_lists.used)
    assert (by_kernel.rooms, by_kernel.closed) == (by_lists.rooms, by_lists.closed)
    assert by_kernel.rooms  # there is something to compare
    for one, other in zip(out, out_by_lists, strict=True):
        assert np.array_equal(one, other)


@pytest.mark.parametrize("seed", range(3))
def test_ways_are_a_widest_tree_and_the_narrowest_on_the_way_out_is_scipys(seed):
    """A widest tree is a least one of negative widths; what gets out is what hangs together over ways as wide."""
    mesh, ways, circle, joined, out = hanging_together(seed)
    nodes = 2 * len(circle)
    outer = np.flatnonzero(mesh.outer[mesh.edge].any(axis=1))
    # The triangles at the frame are one node.
    one, two = (np.where(np.isin(node, outer), outer[0], node) for node in (ways.one, ways.two))

    def graph(rows):
        """Of parallel ways the widest: the graph of scipy has one place for a pair of nodes."""
        rows = rows[(one[rows] != two[rows]) & (ways.width[rows] > 0)]
        rows = rows[np.argsort(ways.width[rows], kind="stable")]
        pair = dict(zip(zip(*np.sort([one[rows], two[rows]], axis=0).tolist(), strict=True), rows, strict=True))
        row = np.array([*pair.values()], dtype=np.int64)
        at = one[row].astype(np.int32), two[row].astype(np.int32)  # older scipys take no others
        return scipy.sparse.coo_array((-ways.width[row], at), (nodes, nodes)).tocsr()

    every = np.arange(len(ways.width))
    tree = csgraph.minimum_spanning_tree(graph(every))
    assert ways.width[joined.used].sum() == pytest.approx(-tree.sum(), rel=1e-12)
    reached = np.flatnonzero((out.narrowest > 0) & np.isfinite(out.narrowest))
    for node in np.random.default_rng(seed).choice(reached, 30):
        width = out.narrowest[node]
        for least, joins in ((width, True), (np.nextafter(width, np.inf), False)):
            _, part = csgraph.connected_components(graph(every[ways.width >= least]), directed=False)
            assert (part[node] == part[outer[0]]) == joins
