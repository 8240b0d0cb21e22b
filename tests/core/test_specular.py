"""Mirrors and panes seen by the globe: sky and diffuse light through any chain, against unfolded scenes."""

import math

import numpy as np
import pytest
from builders import BLACK, DARK, UNIFORM, box, box_polygons, cosine_rays, prepare_coarse, scene_of

import luzespecular as luz
from luzespecular.geometry import make_geometry
from luzespecular.globe import Globe
from luzespecular.outlines import Outlines
from luzespecular.planes import find_planes
from luzespecular.tracing import ChainLimits, exact_mirrors

UP, DOWN, NORTH, SOUTH = np.array([[0, 0, 1.0], [0, 0, -1], [0, 1, 0], [0, -1, 0]])
CLEAR = luz.Daylight(sky=luz.CIESky(12, sun_altitude=40, sun_azimuth=130, horizontal_illuminance=10_000))


def mirror(reflectance):
    return luz.Material(specular_reflectance=reflectance)


def at(transfer, points, normals, light=UNIFORM, **options):
    points = np.atleast_2d(points).astype(float)
    return transfer.solve(light).at(points, np.broadcast_to(normals, points.shape), **options)


def level(size, z=0.0):
    return {"level": np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) * size + [0, 0, z]}


@pytest.mark.parametrize("reflectance", [0.3, 1.0])
@pytest.mark.parametrize("light", [UNIFORM, CLEAR], ids=["uniform", "clear"])
def test_a_mirror_floor_doubles_the_sky(reflectance, light):
    """Seen in a very large mirror floor, the sky stands below the horizon too."""
    open_ = prepare_coarse(scene_of(level(1, -1000)), bands=60)
    mirrored = prepare_coarse(scene_of(level(1e6), mirror(reflectance)), bands=60)
    tilted = np.array([0.48, 0.64, 0.6])
    for normal, image in ((UP, DOWN), (DOWN, UP), (NORTH, NORTH), (tilted, tilted * [1, 1, -1])):
        direct, specular = at(open_, [0, 0, 1], [normal, image][0], light), at(open_, [0, 0, 1], image, light)
        assert at(mirrored, [0, 0, 1], normal, light) == pytest.approx(direct + reflectance * specular, rel=2e-3)


def test_a_mirror_wall_shows_the_sky_in_front_of_it():
    wall = {"wall": np.array([[-1e5, 0, -1e5], [1e5, 0, -1e5], [1e5, 0, 1e5], [-1e5, 0, 1e5]])}  # looks south
    transfer = prepare_coarse(scene_of(wall, mirror(0.7)), bands=60)
    got = at(transfer, [[0, -1, 0], [0, -1, 0]], [UP, NORTH])
    np.testing.assert_allclose(got, np.pi * 1000 * np.array([0.5 + 0.35, 0.35]), rtol=2e-3)
    open_ = prepare_coarse(scene_of(level(1, -1000)), bands=60)
    assert at(transfer, [0, -1, 0], NORTH, CLEAR) == pytest.approx(0.7 * at(open_, [0, 0, 0], SOUTH, CLEAR), rel=2e-3)


@pytest.mark.parametrize(("turned", "two_sided", "share"), [(1, False, 0.7), (-1, False, 0), (-1, True, 0.7)])
def test_a_mirror_reflects_from_its_front_or_from_both_sides(turned, two_sided, share):
    scene = luz.Scene()
    scene.add("mirror", level(1e5)["level"][::turned], mirror(0.7), two_sided=two_sided)
    assert at(prepare_coarse(scene), [0, 0, 1], DOWN) == pytest.approx(share * np.pi * 1000, rel=5e-3, abs=1e-6)


def test_components_keep_direct_and_mirrored_sky_apart():
    scene = luz.Scene()
    scene.add("mirror", level(1e5)["level"], mirror(0.5))
    scene.add("plate", [[0, 1, 1], [1, 1, 1], [1, 1, 2], [0, 1, 2]], BLACK)  # looks south
    result = prepare_coarse(scene, bands=60).solve(UNIFORM)
    plate = result.faces_of("plate")
    np.testing.assert_allclose(result.components["sky_direct"][plate], np.pi * 500, rtol=2e-3)
    np.testing.assert_allclose(result.components["sky_specular"][plate], np.pi * 250, rtol=5e-3)
    assert (result.components["sky_specular"][result.faces_of("mirror")] == 0).all()


def test_ground_light_is_seen_in_mirrors():
    """A mirror ceiling over the receiver shows the ground below the horizon."""
    light = luz.Daylight(sky=luz.UniformSky(1000.0), ground_reflectance=0.4)
    transfer = prepare_coarse(scene_of({"mirror": level(1e5, 1)["level"][::-1]}, mirror(0.9)), bands=60)
    assert at(transfer, [0, 0, 0], UP, light) == pytest.approx(0.9 * 0.4 * np.pi * 1000, rel=2e-3)
    assert at(transfer, [0, 0, 0], UP) == pytest.approx(0, abs=1e-6)


@pytest.fixture(scope="module")
def pipe():
    """Square mirror pipe of width 0.6 and length 1.5 m over a black bottom."""
    size = (0.6, 0.6, 1.5)
    walls = {k: mirror(0.9) for k in ("south", "north", "west", "east")}
    return prepare_coarse(box(BLACK, size, without=("ceiling",), **walls), elements=50, bands=60), size


def unfolded(point, rays, size, reflectance=0.9):
    """Reflectance to the power of the walls that each ray crosses in the unfolded pipe before it leaves at the top."""
    crossed = np.zeros(len(rays))
    for axis in (0, 1):
        top = point[axis] + rays[:, axis] / rays[:, 2] * (size[2] - point[2])
        crossed += np.abs(np.floor(top / size[axis]))
    return reflectance**crossed


@pytest.mark.parametrize("point", [(0.3, 0.3, 0), (0.11, 0.47, 0), (0.3, 0.02, 0), (0.37, 0.2, 0.7)])
def test_a_light_pipe_under_the_sky(pipe, point):
    """Every order of the four walls, and corners; rays cross straight walls in the unfolded pipe."""
    transfer, size = pipe
    rays = cosine_rays(UP)
    expected = np.pi * 1000 * unfolded(np.array(point), rays, size).mean()
    assert at(transfer, point, UP) == pytest.approx(expected, rel=4e-3)


def test_a_light_pipe_under_a_clear_sky(pipe):
    transfer, size = pipe
    rays, point = cosine_rays(UP), np.array([0.2, 0.35, 0])
    reached = rays.copy()
    for axis in (0, 1):
        top = point[axis] + rays[:, axis] / rays[:, 2] * size[2]
        reached[:, axis] *= np.where(np.floor(top / size[axis]) % 2, -1, 1)
    expected = np.pi * (CLEAR.sky_luminance(reached) * unfolded(point, rays, size)).mean()
    assert at(transfer, point, UP, CLEAR) == pytest.approx(expected, rel=4e-3)


@pytest.mark.parametrize("mirrors", [("floor",), ("floor", "north"), ("floor", "ceiling")])
def test_a_closed_room_with_mirrors_sees_no_sky(mirrors):
    room = box(luz.Material(diffuse_reflectance=0.5), **{name: mirror(1.0) for name in mirrors})
    transfer = prepare_coarse(room)
    assert transfer.sky_direct.sums().sum() + transfer.sky_specular.sums().sum() == pytest.approx(0, abs=1e-6)


def test_a_closed_room_with_a_pane_sees_no_sky():
    room = box(luz.Material(diffuse_reflectance=0.5), (2, 1, 1))
    room.add("pane", [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]], luz.Material(regular_transmittance=1.0))
    transfer = prepare_coarse(room)
    assert transfer.sky_direct.sums().sum() == pytest.approx(0, abs=1e-6)
    np.testing.assert_allclose(transfer.form_factors.sum(axis=1), 1, atol=2e-5)


def test_nothing_is_lost_between_perfect_mirrors():
    """Whatever a receiver looks at, patches, sky or chains cut off: it all adds up to one."""
    white, perfect = luz.Material(diffuse_reflectance=0.5), mirror(1.0)
    for options in ({"north": perfect, "floor": perfect}, {"without": ("ceiling",), "west": perfect}):
        transfer = prepare_coarse(box(white, **options))
        total = transfer.form_factors.sum(axis=1) + transfer.sky_direct.dense().sum(axis=1) + transfer.truncated
        total += transfer.sky_specular.dense().sum(axis=1)
        np.testing.assert_allclose(total, 1, atol=2e-5)


def test_what_is_cut_off_is_booked():
    """Two facing mirrors and open sides: light followed and light cut add up, whatever the cut-off."""
    plates = box_polygons((1, 1, 0.05))
    scene = scene_of({k: plates[k] for k in ("floor", "ceiling")}, mirror(1.0))
    fine, coarse = (prepare_coarse(scene, elements=80, specular_cutoff=c) for c in (1e-3, 1.0))
    for transfer in (fine, coarse):
        total = transfer.sky_direct.dense().sum(axis=1) + transfer.truncated
        total += transfer.sky_specular.dense().sum(axis=1)
        np.testing.assert_allclose(total, 1, atol=1e-3)
    weak = scene_of({k: plates[k] for k in ("floor", "ceiling")}, mirror(0.5))
    followed, cut = (prepare_coarse(weak, specular_cutoff=c) for c in (1e-3, 0.3))
    assert 0 < followed.truncated.mean() < 0.05 * cut.truncated.mean()
    assert cut.truncated.max() <= 0.25 + 1e-6, "two reflections of one half were made before the cut"


@pytest.mark.parametrize("emitting", ["ceiling", "south", "east"])
def test_a_room_with_a_mirror_wall_is_half_of_a_double_room(emitting):
    """A perfect mirror in the middle of a symmetric room changes nothing: diffuse light, by all cycles."""
    white, glow = luz.Material(diffuse_reflectance=0.6), luz.Material(diffuse_reflectance=0.6, exitance=1000)
    half = prepare_coarse(box(white, (2, 1.5, 2), north=mirror(1.0), **{emitting: glow}), elements=800, patches=250)
    double = (
        {"ceiling": glow} if emitting == "ceiling" else {emitting: glow, "north": glow} if emitting == "south" else {}
    )
    scene = box(white, (2, 3, 2), **({"east": glow} if emitting == "east" else double))
    whole = prepare_coarse(scene, elements=1600, patches=500)
    points = [[1, 0.7, 0], [0.3, 1.4, 0], [2, 0.5, 1.2], [1.2, 0, 0.6], [0.6, 1.1, 1.0]]
    normals = [UP, UP, [-1, 0, 0], NORTH, [0.6, 0, 0.8]]
    one, other = half.solve(DARK), whole.solve(DARK)
    np.testing.assert_allclose(one.at(points, normals), other.at(points, normals), rtol=5e-3)
    np.testing.assert_allclose(
        one.at(points, normals, initial=True), other.at(points, normals, initial=True), rtol=1e-6
    )
    assert one.mean("south") == pytest.approx(other.mean("south"), rel=3e-3)


def test_mixed_reflection_is_partly_mirror_partly_diffuse():
    """A wall of rho_d and rho_s under a lamp gives the sum of what each alone would give (it does not see itself)."""
    lamp = [[0.6, -0.4, 0.5], [0.6, -0.4, 2.0], [2.6, -0.4, 2.0], [2.6, -0.4, 0.5]]
    wall = [[0, 0, 0], [0, 3, 0], [0, 3, 2.5], [0, 0, 2.5]]

    def received(**shares):
        scene = luz.Scene()
        scene.add("lamp", lamp, luz.Material(exitance=1000))
        scene.add("wall", wall, luz.Material(**shares))
        return at(prepare_coarse(scene, elements=800, patches=400), [1.5, 1.2, 1], [-1, 0, 0], DARK)[0]

    none = received()
    both = received(diffuse_reflectance=0.4, specular_reflectance=0.5)
    apart = received(diffuse_reflectance=0.4) - none + received(specular_reflectance=0.5) - none
    assert both - none == pytest.approx(apart, rel=1e-3)
    assert received(diffuse_reflectance=0.4) > none < received(specular_reflectance=0.5)


@pytest.mark.parametrize("turned", [1, -1])
def test_a_plain_pane_dims_the_sky_evenly(turned):
    pane = {"pane": level(1e5, 1)["level"][::turned]}
    transfer = prepare_coarse(scene_of(pane, luz.Material(regular_transmittance=0.8)), bands=60)
    for light in (UNIFORM, CLEAR):
        clear = light.sky_illuminance
        assert at(transfer, [0, 0, 0], UP, light) == pytest.approx(0.8 * clear, rel=2e-3)
    assert at(transfer, [0, 0, 2], UP) == pytest.approx(np.pi * 1000, rel=1e-6)
    assert at(transfer, [0, 0, 2], DOWN) == pytest.approx(0, abs=1e-6), "no ground, no mirror"


@pytest.mark.parametrize("turned", [1, -1])
def test_a_glass_pane_under_the_sky(turned):
    """Hemispherical transmittance by quadrature; from above, the sky's image in the pane."""
    glass = luz.Material(regular_transmittance=0.9, refractive_index=1.52)
    transfer = prepare_coarse(scene_of({"pane": level(1e5, 1)["level"][::turned]}, glass), bands=60)
    nodes, weights = np.polynomial.legendre.leggauss(200)
    cosine = (nodes + 1) / 2
    through, back = (float((weights * cosine) @ f(cosine)) for f in (glass.transmittance_at, glass.specular_at))
    assert at(transfer, [0, 0, 0], UP) == pytest.approx(np.pi * 1000 * through, rel=2e-3)
    assert at(transfer, [0, 0, 2], DOWN) == pytest.approx(np.pi * 1000 * back, rel=3e-3)


def test_a_point_in_a_glass_house():
    """Every wall and the roof of the same plain pane: all light crosses one of them once."""
    house = prepare_coarse(box(luz.Material(regular_transmittance=0.7), (4, 3, 2.5), floor=BLACK), bands=60)
    got = at(house, [[1, 1, 0], [3.2, 2.9, 0], [2, 1.5, 1]], UP)
    np.testing.assert_allclose(got, 0.7 * np.pi * 1000, rtol=1e-4)
    assert at(house, [2, 1.5, 1], NORTH) == pytest.approx(0.7 * np.pi * 500, rel=1e-3)


def test_diffuse_light_passes_panes(by_globe):
    """Two rooms with a pane between: what crosses is dimmed once, and comes back dimmed again."""
    glow = luz.Material(exitance=1000)
    rooms = {f"a {k}": p for k, p in box_polygons((2, 1, 1)).items()}
    dim = {}
    for share in (1.0, 0.5):
        scene = scene_of(rooms, luz.Material(diffuse_reflectance=0.5), **{"a west": glow})
        scene.add("pane", [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]], luz.Material(regular_transmittance=share))
        dim[share] = prepare_coarse(scene, elements=600, patches=300).solve(DARK, cycles=1)
    bare = prepare_coarse(
        scene_of(rooms, luz.Material(diffuse_reflectance=0.5), **{"a west": glow}), elements=600, patches=300
    ).solve(DARK, cycles=1)
    assert dim[1.0].mean("a east") == pytest.approx(bare.mean("a east"), rel=2e-3)
    far = np.array([[2, 0.5, 0.5]])
    initial = [r.at(far, [[-1, 0, 0]], initial=True)[0] for r in (bare, dim[0.5])]
    assert initial[1] == pytest.approx(0.5 * initial[0], rel=1e-9)


def test_no_mirror_no_chains():
    stages = prepare_coarse(box(BLACK)).stages
    skipped = {s.name: s.skipped for s in stages}
    assert skipped["specular chains"] == "no surface mirrors or transmits regularly"
    assert not {s.name: s.skipped for s in prepare_coarse(box(BLACK, floor=mirror(0.5))).stages}.get("specular chains")


@pytest.mark.parametrize(
    ("mirrors", "deepest"),
    [(0, 40), (1, 40), (2, 40), (3, 4), (4, 3), (6, 3), (7, 2), (10, 1), (100, 1), (150, 0)],
)
def test_how_many_mirrors_are_looked_into_one_by_one(mirrors, deepest):
    """Two facing mirrors: all images to the cut-off. A box: the first 62. More tiles of mirror: each, once."""
    plate = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    scene = luz.Scene()
    for k in range(mirrors):
        scene.add(f"mirror {k}", plate + 0.01 * k * UP, mirror(0.9))
    scene.add("grey", plate + DOWN, luz.Material(diffuse_reflectance=0.5))
    assert exact_mirrors(make_geometry(scene, find_planes(scene), Globe(4), math.inf).outlines) == deepest


@pytest.mark.parametrize(
    ("lamps", "aslant", "deepest"), [(240, 0.0, 0), (0, 0.0, 3), (4, 0.0, 3), (20, 0.0, 1), (0, 0.3, 2), (4, 0.3, 2)]
)
def test_images_are_fewer_where_many_surfaces_shine_or_mirrors_stand_aslant(lamps, aslant, deepest):
    """The images of six mirrors at any angle are as many as the ways between them; each lamp shows in all of them."""
    scene = luz.Scene()
    for k, polygon in enumerate(box_polygons().values()):
        scene.add(f"mirror {k}", polygon + aslant * np.outer(polygon[:, k % 3], np.eye(3)[(k + 1) % 3]), mirror(0.9))
    for k in range(lamps):
        place = [0.1 + 0.03 * k, 0.5, 0.5]
        scene.add(f"lamp {k}", 0.02 * box_polygons()["floor"] + place, luz.Material(exitance=1.0), two_sided=k % 2 > 0)
    assert exact_mirrors(make_geometry(scene, find_planes(scene), Globe(4), math.inf).outlines) == deepest


def test_sightings_of_few_and_of_many_mirrors_are_told_apart():
    limits = ChainLimits(exact_mirrors=3)
    assert limits.kind(np.arange(7)).tolist() == [0, 1, 1, 1, 4, 4, 4]
    assert ChainLimits(exact_mirrors=1).kind(np.arange(4)).tolist() == [0, 1, 2, 2]


def test_no_light_leaks_at_the_edges_of_mirrors():
    """A closed box of which one, two, three sides are mirrors: no sky, and rows of the form factors make one."""
    grey = luz.Material(diffuse_reflectance=0.5)
    for mirrors in (("floor",), ("floor", "west"), ("floor", "west", "south")):
        transfer = prepare_coarse(
            box(grey, (2, 1.5, 1.2), **{name: mirror(1.0) for name in mirrors}), elements=60, patches=60
        )
        assert transfer.sky_direct.dense().sum(axis=1).max() < 1e-6
        assert transfer.sky_specular.dense().sum(axis=1).max() < 2e-5
        np.testing.assert_allclose(transfer.form_factors.sum(axis=1) + transfer.truncated, 1, atol=1e-4)
        assert transfer.solve(UNIFORM).illuminance.max() < 0.2, "of 3142 lx outside"


def test_single_rays_see_what_shared_views_see(monkeypatch):
    """Scenes of many outlines are seen by one ray for each parcel: the same, but coarser."""
    scene = box(BLACK, (3, 3, 3), without=("north",), floor=mirror(0.8), west=luz.Material(diffuse_reflectance=0.5))
    scene.add("shelf", [[0, 2, 1.5], [3, 2, 1.5], [3, 3, 1.5], [0, 3, 1.5]], mirror(0.9))
    shared = prepare_coarse(scene, elements=100, patches=50, bands=60)
    for name in ("MANY_OUTLINES", "_FEWEST_LARGE", "_MOST_LARGE"):
        monkeypatch.setattr(f"luzespecular.facets.{name}", 0)
    single = prepare_coarse(scene, elements=100, patches=50, bands=60)
    one, other = shared.solve(CLEAR), single.solve(CLEAR)
    for name in ("south", "ceiling", "east", "west", "floor"):
        assert other.mean(name) == pytest.approx(one.mean(name), rel=0.02)
    one, other = (t.on_elements(t.form_factors.sum(axis=1)) for t in (shared, single))
    np.testing.assert_allclose(one, other, atol=0.02)
    assert not np.array_equal(one, other), "two ways"
    assert math.isclose(shared.truncated.sum(), single.truncated.sum(), abs_tol=0.02 * len(shared.truncated))


def test_flights_from_mirror_to_mirror_leave_out_nothing(monkeypatch):
    """As when each mirror is a stop of its own; one is two-sided, one diffuse besides, one a pane."""
    materials = {
        "west": mirror(0.9),
        "east": mirror(0.8),
        "south": luz.Material(specular_reflectance=0.5, diffuse_reflectance=0.3),
        "floor": luz.Material(diffuse_reflectance=0.4),
        "ceiling": luz.Material(regular_transmittance=0.8),
    }
    room = box(without=("north",), **materials)
    room.add(
        "shelf",
        np.array([[0.2, 0.3, 0.6], [0.8, 0.3, 0.6], [0.8, 0.6, 0.5], [0.2, 0.6, 0.5]]),
        mirror(0.7),
        two_sided=True,
    )
    found = []
    for plain in (True, False):
        if not plain:
            stops = lambda outlines: np.zeros((2, len(outlines.materials)))  # noqa: E731
            monkeypatch.setattr(Outlines, "plain_mirrors", property(stops))
        result = prepare_coarse(room, bands=20).solve(CLEAR)
        points = np.array([[0.5, 0.5, 0.01], [0.3, 0.4, 0.3], [0.7, 0.45, 0.9]])
        found.append(np.concatenate([result.illuminance, result.at(points, np.broadcast_to(UP, (3, 3)))]))
        assert abs(result.balance.defect) < 1e-3
    np.testing.assert_allclose(found[0], found[1], rtol=1e-5)
