"""The bundled scene file is the light-shelf room with the mirror shelf, to the last bit."""

from pathlib import Path

import numpy as np

from luzespecular import files

PATH = Path(__file__).resolve().parents[2] / "examples" / "light_shelf" / "light_shelf.json"


def test_the_bundled_scene_is_the_light_shelf_room(example):
    read, written = files.read_scene(PATH).scene, example("light_shelf/room.py").scene("S1")
    assert list(read.surfaces) == list(written.surfaces)
    for name, surface in read.surfaces.items():
        assert surface.material == written.surfaces[name].material
        assert surface.two_sided == written.surfaces[name].two_sided
        np.testing.assert_array_equal(surface.pieces, written.surfaces[name].pieces)
