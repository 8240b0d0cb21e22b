"""Layout: where surfaces touch a run of cells, which cells they cut, and stretches that end there."""

import numpy as np
import pytest
from builders import box_polygons
from hypothesis import given, settings
from hypothesis import strategies as st
from layout_samples import BLACK, WHITE, geometry_of, shelf, wall, wall_and

import luzespecular as luz
from luzespecular import layout as layout_module


def layout_of(*shelves):
    """Layout of the wall: rows run up, columns run east."""
    return only(geometry_of(wall_and(*shelves)))


def only(geometry):
    assert len(geometry.lattices) == 1
    return geometry.lattices[0]


def test_a_wall_that_nothing_touches_is_one_stretch():
    layout = layout_of()
    assert (layout.grid.rows, layout.grid.columns) == (10, 20)
    np.testing.assert_allclose(layout.grid.along_rows, [0, 0, 0.1], atol=1e-15)
    assert layout.stretches == ([(0, 10)], [(0, 20)])
    assert layout.contacts.shape == (0, 2, 2) and not layout.cut.any()


@pytest.mark.parametrize(
    ("depth", "ends", "touches"),
    [
        ((0.0, 0.5), True, True),
        ((-0.5, 0.0), True, True),  # from behind: its shadow does not end here, and it does no harm
        ((-0.3, 0.3), True, True),  # through the wall
        ((1e-3, 0.5), True, False),  # light changes there as fast
        ((0.3, 0.5), True, False),
        ((0.45, 0.9), False, False),
        ((-0.5, -1e-3), False, False),
    ],
)
def test_stretches_end_where_something_touches_or_crosses_or_passes_close(depth, ends, touches):
    layout = layout_of(shelf(0.4, y=depth))
    assert layout.stretches == (([(0, 4), (4, 6)] if ends else [(0, 10)]), [(0, 20)])
    assert not layout.cut.any(), "the line runs between cells"
    if touches:
        np.testing.assert_allclose(np.sort(layout.contacts[0], axis=0), [[4, 0], [4, 20]], atol=1e-9)


def test_a_line_within_cells_cuts_them():
    layout = layout_of(shelf(0.43))
    assert layout.stretches == ([(0, 4), (4, 1), (5, 5)], [(0, 20)])
    np.testing.assert_array_equal(np.flatnonzero(layout.cut.any(axis=1)), [4])
    assert layout.cut[4].all()


def test_stretches_end_beside_the_ends_of_a_short_shelf():
    """Light bends round its ends: what is beside them is not told by what is before it."""
    layout = layout_of(shelf(0.4, x=(0.5, 1.5)))
    assert layout.stretches == ([(0, 4), (4, 6)], [(0, 5), (5, 10), (15, 5)])
    layout = layout_of(shelf(0.43, x=(0.52, 1.48)))
    assert layout.stretches[1] == [(0, 5), (5, 1), (6, 8), (14, 1), (15, 5)]
    np.testing.assert_array_equal(np.argwhere(layout.cut), [[4, k] for k in range(5, 15)])


def test_walls_along_the_border_are_no_contacts():
    scene = wall()
    scene.add("floor", [[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]], BLACK)
    scene.add("ceiling", [[0, 0, 1], [0, 1, 1], [2, 1, 1], [2, 0, 1]], BLACK)
    scene.add("west", [[0, 0, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1]], BLACK)
    layout = only(geometry_of(scene))
    assert layout.stretches == ([(0, 10)], [(0, 20)]) and not len(layout.contacts) and not layout.cut.any()


def test_a_corner_that_touches_is_no_line():
    layout = layout_of([[1.03, 0, 0.55], [0.8, 0.3, 0.3], [1.2, 0.3, 0.3]])
    assert layout.stretches == ([(0, 10)], [(0, 20)]) and not layout.cut.any()


def test_what_stands_beside_the_wall_in_its_plane_does_not_touch_it():
    layout = layout_of(shelf(0.4, x=(2.5, 3.0)))
    assert layout.stretches == ([(0, 10)], [(0, 20)]) and not len(layout.contacts)


def test_an_oblique_line_cuts_the_cells_on_its_way():
    """From (0.35, 0.15) at 45 degrees: seven cells of a staircase, and stretches end in those of its ends."""
    layout = layout_of([[0.35, 0, 0.15], [0.95, 0, 0.75], [0.95, 1, 0.75], [0.35, 1, 0.15]])
    np.testing.assert_array_equal(np.argwhere(layout.cut), [[1 + k, 3 + k] for k in range(7)])
    assert layout.stretches == (
        [(0, 1), (1, 1), (2, 5), (7, 1), (8, 2)],
        [(0, 3), (3, 1), (4, 5), (9, 1), (10, 10)],
    )


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.floats(0.001, 0.999), st.floats(0, 1.9), st.floats(0.01, 2.0)), max_size=4))
def test_stretches_share_out_the_wall_and_no_line_runs_within_one(places):
    """Whole cells, once each; a line between rows or columns never lies inside a stretch, nor do a line's ends."""
    layout = layout_of(*[shelf(z, x=(x, min(2.0, x + width))) for z, x, width in places])
    for axis, count in ((0, 10), (1, 20)):
        stretches = layout.stretches[axis]
        assert [first for first, _ in stretches] == np.cumsum([0, *[n for _, n in stretches]])[:-1].tolist()
        assert sum(n for _, n in stretches) == count and min(n for _, n in stretches) > 0
        for place in layout.contacts[:, :, axis].ravel():
            first, cells = max(s for s in stretches if s[0] <= place + 1e-5)
            inside = first + 2e-5 < place < first + cells - 2e-5
            assert not inside or cells == 1, "what a line ends or runs in is a stretch by itself"
    for row in np.flatnonzero(layout.cut.any(axis=1)):
        assert (row, 1) in layout.stretches[0]


def test_many_lines_are_left_to_be_found_by_doubt():
    layout = layout_of(*[shelf(z) for z in np.linspace(0.03, 0.97, 14)])
    assert layout.stretches == ([(0, 10)], [(0, 20)])
    assert len(layout.contacts) == 14 and layout.cut.all(axis=1).sum() == 10


def test_the_back_of_a_two_sided_wall_has_a_layout_of_its_own():
    scene = wall(two_sided=True)
    scene.add("shelf", shelf(0.4), BLACK)
    geometry = geometry_of(scene)
    assert len(geometry.lattices) == 2
    front, back = geometry.lattices
    assert front.stretches == back.stretches == ([(0, 4), (4, 6)], [(0, 20)])
    sheets = [geometry.fracture.element_sheet[lattice.grid.elements] for lattice in (front, back)]
    assert (sheets[0] == 0).all() and (sheets[1] == 2).all()
    assert back.grid.first == 402, "the backs follow all fronts, the shelf's two among them"


def test_only_runs_of_cells_have_layouts():
    """Triangles, and surfaces too small to tell how light changes on them, have receivers of their own."""
    scene = luz.Scene()
    scene.add("triangle", [[0, 0, 0], [1, 0, 0], [0, 1, 0]], WHITE)
    scene.add("chip", [[0, 0, 1], [0.1, 0, 1], [0.1, 0.1, 1], [0, 0.1, 1]], WHITE)
    assert geometry_of(scene).lattices == []


@pytest.mark.parametrize("gap", [1e-7, 9e-7, 1.1e-6, 1.4e-6, 2e-6, 1e-3])
@pytest.mark.parametrize("count", [1, 5, 7])
def test_stretches_fill_a_run_however_close_to_its_end_things_touch(gap, count):
    """Found by a pane a micrometre before a wall: one stretch more than there were cells."""
    for place in (gap, count - gap):
        stretches = layout_module._stretches(count, np.array([place]), np.zeros(0), 1)
        assert sum(cells for _, cells in stretches) == count and min(cells for _, cells in stretches) > 0


@pytest.mark.parametrize("turn", [0.0, 0.6])
def test_the_breadth_of_a_corridor_is_its_larger_extent_across(turn):
    """However it lies; and spaces between receivers along it follow."""
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    scene = luz.Scene()
    for name, polygon in box_polygons((1.8, 60, 2.6)).items():
        scene.add(name, np.array(polygon, float) @ rotation.T, WHITE)
    geometry = geometry_of(scene)
    assert layout_module.breadth_of(geometry.planes) == pytest.approx(2.6, rel=1e-9)
    for lattice in geometry.lattices:
        np.testing.assert_allclose(lattice.widest * lattice.grid.sides, 1.3, rtol=1e-9)


def test_cells_beside_a_line_askew():
    """From (0.35, 0.15) to (0.95, 0.75): cells within so many cells of it, and none for lines along the axes."""
    layout = layout_of([[0.35, 0, 0.15], [0.95, 0, 0.75], [0.95, 1, 0.75], [0.35, 1, 0.15]])
    row, column = np.divmod(layout.beside_askew(1.0), 20)
    assert len(row) > 10
    across = np.abs((column + 0.5) - (row + 0.5) - 2) / np.sqrt(2)
    assert across.max() < 1.0
    assert not len(layout_of(shelf(0.4)).beside_askew(5.0))
