"""Walls that shelves touch, cut into cells, and means over faces: what tests of layout, nodes and patches share."""

import numpy as np
import pytest

import luzespecular as luz
from luzespecular import fracture, geometry
from luzespecular.geometry import make_geometry
from luzespecular.globe import Globe
from luzespecular.planes import find_planes

BLACK = luz.Material()
WHITE = luz.Material(diffuse_reflectance=0.5)
CELL = 0.1
"""Side of the cells [m]: two triangles of `AREA` each."""

AREA = CELL**2 / 2


def wall(width=2.0, height=1.0, two_sided=False, material=WHITE):
    """Scene of a wall in the plane y = 0 that looks north: 20 columns along x and 10 rows along z."""
    scene = luz.Scene()
    scene.add(
        "wall",
        np.array([[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]]) * [width, 1, height],
        material,
        two_sided=two_sided,
    )
    return scene


def shelf(z, x=(0.0, 2.0), y=(0.0, 0.5)):
    """(4, 3): level rectangle before the wall."""
    return [[x[0], y[0], z], [x[1], y[0], z], [x[1], y[1], z], [x[0], y[1], z]]


def wall_and(*shelves, **options):
    """The wall with black rectangles before it."""
    scene = wall(**options)
    for number, polygon in enumerate(shelves):
        scene.add(f"shelf {number}", polygon, BLACK)
    return scene


def geometry_of(scene, max_area=AREA, patches=100, elements=8):
    """A scene made ready, its elements no finer than its faces."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fracture, "FEWEST_ELEMENTS", elements)
        patch.setattr(fracture, "ELEMENTS_PER_PLAIN_SURFACE", 0.1)
        patch.setattr(fracture, "MOST_FINER", 0)
        patch.setattr(geometry, "PATCHES", patches)
        return make_geometry(scene, find_planes(scene), Globe(4), max_area)


def triangle_rule(parts):
    """(parts², 3): barycentric centroids of a triangle's equal parts."""
    upright = [(i + 1 / 3, j + 1 / 3) for i in range(parts) for j in range(parts - i)]
    turned = [(i + 2 / 3, j + 2 / 3) for i in range(parts - 1) for j in range(parts - 1 - i)]
    places = np.array(upright + turned) / parts
    return np.c_[places, 1 - places.sum(axis=1)]
