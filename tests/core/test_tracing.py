"""Single rays through panes that mirror as well: bounded in number, and still the light of all chains."""

import numpy as np
import pytest
from builders import box_polygons

import luzespecular as luz
from luzespecular import tracing
from luzespecular.globe import Globe
from luzespecular.outlines import Outlines
from luzespecular.planes import find_planes
from luzespecular.specular import GroupSight
from luzespecular.views import OPEN

GLASS = luz.Material(regular_transmittance=0.85, refractive_index=1.52)


def stack_transmittance(panes: int) -> float:
    """Of diffuse light through parallel panes, with all that they throw to and fro between them."""
    share = (np.arange(20_000) + 0.5) / 20_000
    cosine = np.sqrt(1 - share)
    mirrored, through = GLASS.specular_at(cosine), GLASS.transmittance_at(cosine)
    back, on = np.zeros_like(share), np.ones_like(share)
    for _ in range(panes):
        gap = 1 - back * mirrored
        on, back = on * through / gap, mirrored + through**2 * back / gap
    return float(on.mean())


def seen_through(panes: int, points, bands: int, monkeypatch) -> tuple[np.ndarray, np.ndarray, int]:
    """Share of the sky that points see through a wide stack, what was cut off, and the steps of rays for each point."""
    scene, square = luz.Scene(), np.array([[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]])
    scene.add("floor", square, luz.Material())
    for k in range(panes):
        scene.add(f"pane {k}", square + np.array([0, 0, 4e-5 * (k + 1)]), GLASS)
    planes = find_planes(scene)
    normals = planes.sheet_normal[planes.outline_sheet]
    offsets = np.einsum("oc,oc->o", normals, planes.outlines[:, 0])
    materials = [surface.material for surface in scene.surfaces.values()]
    outlines = Outlines(planes.outlines, normals, offsets, materials, np.zeros(panes + 1, bool), 1e-9 * planes.size)
    steps, after = [], tracing.Tracer.after

    def counted(self, rays, *others):
        steps.append(len(rays.rows))
        return after(self, rays, *others)

    monkeypatch.setattr(tracing.Tracer, "after", counted)
    points = np.asarray(points, float) - planes.centre
    sight = GroupSight(outlines, Globe(bands).hemisphere(np.array([0, 0, 1.0])), points[0, 2], tracing.ChainLimits())
    seen = np.zeros(len(points))
    sightings, truncated = sight.sightings(points)
    for s in sightings:
        mine = s.view.part_seen == OPEN
        seen += np.bincount(s.rows[s.view.part_row[mine]], s.part_weights()[mine], len(points))
        if not s.rays:
            seen += np.bincount(s.rows, np.where(s.view.seen == OPEN, s.weights, 0.0).sum(axis=1), len(points))
    return seen, truncated, sum(steps) // len(points)


@pytest.mark.parametrize("panes", [2, 6, 10])
def test_panes_that_mirror_show_all_orders_of_their_light(panes, monkeypatch):
    seen, truncated, steps = seen_through(panes, [[0, 0, 0], [0.01, 0.02, 0]], 24, monkeypatch)
    assert seen == pytest.approx(stack_transmittance(panes), rel=0.012)
    assert truncated.max() < 3e-3
    # all chains of ten panes would be some 10^5 steps
    assert steps < 10_000


def test_thinned_rays_carry_the_weight_of_all():
    rng = np.random.default_rng(3)
    rows, weights = rng.integers(0, 5, 4_000), rng.uniform(0, 4e-4, 4_000)
    kept, heavier = tracing.thinned(rows, weights, tracing._FAINT)
    whole, after = np.bincount(rows, weights, 5), np.bincount(rows[kept], heavier, 5)
    assert len(kept) < 3_000
    assert np.abs(after - whole).max() <= 4e-4
    assert (heavier >= weights[kept] * (1 - 1e-12)).all()


def test_what_is_thinned_does_not_depend_on_other_receivers():
    rng = np.random.default_rng(4)
    rows, weights = rng.integers(0, 4, 1_000), rng.uniform(0, 4e-4, 1_000)
    kept, heavier = tracing.thinned(rows, weights, tracing._FAINT)
    mine = rows == 2
    alone, heavy = tracing.thinned(rows[mine], weights[mine], tracing._FAINT)
    assert np.array_equal(np.flatnonzero(mine)[alone], kept[rows[kept] == 2])
    assert heavy == pytest.approx(heavier[rows[kept] == 2])


def to_window(points, normals, distances) -> np.ndarray:
    """(n, k) form factors to a window of 1 m × 0.8 m across y = 0 from points so much farther off."""
    steps = (np.arange(50) + 0.5) / 50
    x, z = (grid.ravel() for grid in np.meshgrid(0.5 + steps, 0.8 + 0.8 * steps))
    found = np.empty((len(points), len(distances)))
    for k, far in enumerate(distances):
        way = np.stack([x, np.full_like(x, far), z], axis=1) - points[:, None, :]
        square = (way**2).sum(axis=2)
        cosines = np.maximum(np.einsum("npc,nc->np", way, normals), 0) * way[..., 1]
        found[:, k] = 0.8 * (cosines / square**2).mean(axis=1) / np.pi
    return found


def test_a_window_behind_two_panes_that_mirror_keeps_its_edges():
    scene, black = luz.Scene(), luz.Material(diffuse_reflectance=1e-6)
    walls = box_polygons((2, 6, 2))
    for name in ("floor", "south", "west", "east", "ceiling"):
        scene.add(name, walls[name], black)
    for name, (x, z, width, height) in {
        "sill": (0, 0, 2, 0.8),
        "lintel": (0, 1.6, 2, 0.4),
        "left": (0, 0.8, 0.5, 0.8),
        "right": (1.5, 0.8, 0.5, 0.8),
    }.items():
        corner, across, up = np.array([x, 6, z]), np.array([width, 0, 0]), np.array([0, 0, height])
        scene.add(name, [corner, corner + across, corner + across + up, corner + up], black)
    for y in (3.0, 4.5):
        pane = luz.Material(specular_reflectance=0.3, regular_transmittance=0.5)
        scene.add(f"pane {y}", [[0, y, 0], [2, y, 0], [2, y, 2], [0, y, 2]], pane, two_sided=True)
    light = luz.Daylight(sky=luz.UniformSky(1000), ground_reflectance=1.0)
    result = luz.solve(scene, light, max_area=0.05, threads=1)
    for name in ("floor", "south"):
        faces = result.faces_of(name)
        faces = faces[result.centroids[faces, 1] < 2.5]
        # two panes 1.5 m apart show the window again and again, 3 m farther off each time
        shown = to_window(result.centroids[faces], result.normals[faces], 6 + 3.0 * np.arange(6))
        expected = 1000 * np.pi * 0.5**2 * shown @ 0.3 ** (2 * np.arange(6))
        errors = result.initial[faces] / expected - 1
        assert np.sqrt((errors**2).mean()) < 0.05, name
        assert abs(np.average(errors, weights=expected)) < 0.01, name
