"""Work planes: grids of points in mid-air, such as desk height, with lux computed at the points themselves.

A work plane is an object of the user's, each of whose faces is one point of the grid: its centre, looking to where the
face's normal looks. It takes no part in the light. Move, scale or edit it as any other mesh, and solve again.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from .. import core as luz
from ..core import tables
from . import mesh_arrays, writeback

HEIGHT = 0.75
"""Usual height of a work plane above the floor [m] (EN 12464-1 and NBR ISO/CIE 8995-1 for desks)."""

_CHUNK = 128


@dataclass(frozen=True)
class Grid:
    """The points of one work plane.

    Attributes
    ----------
    object_name : str
    points, normals : (m, 3) float
        [m]; one for each face of the object's mesh.
    state : str
        Changes with place and shape of the object.
    """

    object_name: str
    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    state: str


@dataclass(frozen=True)
class Reading:
    """What was read on one grid: (m,) floats [lx] for each of `tables.QUANTITIES`."""

    grid: Grid
    values: dict[str, NDArray[np.float64]]


@dataclass(frozen=True)
class Statistics:
    """Illuminance over a work plane.

    Attributes
    ----------
    area : float
        [m²]
    minimum, mean, maximum : float
        [lx], the mean weighted by area.
    share_above : float
        Share of the area with at least a threshold, 0 to 1.
    """

    area: float
    minimum: float
    mean: float
    maximum: float
    share_above: float

    @property
    def uniformity(self) -> float:
        """Minimum over mean (EN 12665, U₀); NaN in the dark."""
        return self.minimum / self.mean if self.mean > 0.0 else float("nan")


def statistics(illuminance: NDArray, areas: NDArray, threshold: float) -> Statistics | None:
    """Return the statistics of faces with values; None where there are none."""
    known = ~np.isnan(illuminance)
    values, areas = np.asarray(illuminance, float)[known], np.asarray(areas, float)[known]
    if not len(values) or not areas.sum() > 0.0:
        return None
    return Statistics(
        area=float(areas.sum()),
        minimum=float(values.min()),
        mean=float(np.average(values, weights=areas)),
        maximum=float(values.max()),
        share_above=float(areas[values >= threshold].sum() / areas.sum()),
    )


def all_of(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """Return the work planes of a scene."""
    return [object_ for object_ in scene.objects if object_.type == "MESH" and object_.luzespecular.plane.enabled]


def grids(scene: bpy.types.Scene, unit_scale: float) -> list[Grid]:
    """Return the grids of all work planes that have faces."""
    return [_grid(object_, unit_scale) for object_ in all_of(scene) if object_.data.polygons]


def state_of(object_: bpy.types.Object) -> str:
    """Return a text that changes with place and shape of a work plane."""
    mesh = object_.data
    digest = hashlib.blake2b(digest_size=8)
    digest.update(np.array(object_.matrix_world, np.float32).tobytes())
    digest.update(mesh_arrays.vertex_positions(mesh))
    digest.update(mesh_arrays.corner_vertices(mesh))
    return digest.hexdigest()


def _grid(object_: bpy.types.Object, unit_scale: float) -> Grid:
    matrix = np.array(object_.matrix_world)
    points = mesh_arrays.polygon_centres(object_.data).astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
    turned = mesh_arrays.polygon_normals(object_.data).astype(float) @ np.linalg.pinv(matrix[:3, :3])
    return Grid(object_.name, points * unit_scale, _straight(turned), state_of(object_))


def _straight(normals: NDArray) -> NDArray:
    """Return unit normals, rounded so that those of one plane are alike to the last digit; up where there is none."""
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.where(length > 0.0, normals / np.maximum(length, 1e-300), [0.0, 0.0, 1.0])
    normals = np.round(normals, 6)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def read(result: luz.Result, grids_: Iterable[Grid], progress: Callable[[float, str], bool]) -> list[Reading]:
    """Compute the light on grids, in any thread; raises `luz.Cancelled` when `progress` says so."""
    grids_ = list(grids_)
    count = sum(len(grid.points) for grid in grids_)
    readings, done = [], 0
    for grid in grids_:
        values = {name: np.full(len(grid.points), np.nan) for name in tables.QUANTITIES}
        for start in range(0, len(grid.points), _CHUNK):
            if not progress(done / count, "work planes"):
                raise luz.Cancelled("Cancelled at: work planes")
            some = slice(start, start + _CHUNK)
            for name, lux in tables.point_quantities(result, grid.points[some], grid.normals[some]).items():
                values[name][some] = lux
            done += len(grid.points[some])
        readings.append(Reading(grid, values))
    return readings


def write(scene: bpy.types.Scene, readings: Sequence[Reading]) -> None:
    """Write readings to their work planes; planes that were not read lose what they had."""
    by_name = {reading.grid.object_name: reading for reading in readings}
    for object_ in all_of(scene):
        reading = by_name.get(object_.name)
        mesh = object_.data
        if reading is None or len(reading.grid.points) != len(mesh.polygons):
            if writeback.holds_results(mesh):
                writeback.clear(mesh)
            object_.luzespecular.plane.property_unset("state")
            continue
        writeback.begin(mesh)
        for name, values in reading.values.items():
            mesh_arrays.write_face_floats(mesh, writeback.attribute_of(name), values)
        object_.luzespecular.plane.state = reading.grid.state


def forget_values(scene: bpy.types.Scene) -> None:
    """Forget that the work planes were read."""
    for object_ in all_of(scene):
        object_.luzespecular.plane.property_unset("state")


def statistics_of(object_: bpy.types.Object, unit_scale: float, quantity: str = "illuminance") -> Statistics | None:
    """Return the statistics of a quantity on a work plane; None where it has not been read."""
    values = mesh_arrays.read_face_values(object_.data, writeback.attribute_of(quantity), np.float32)
    if values is None:
        return None
    areas = mesh_arrays.polygon_areas(object_.data) * _area_scale(object_) * unit_scale**2
    return statistics(values, areas, object_.luzespecular.plane.threshold)


def _area_scale(object_: bpy.types.Object) -> float:
    """Return by what the object's scale multiplies areas that lie as its faces lie on the average."""
    normals = mesh_arrays.polygon_normals(object_.data).astype(float)
    matrix = np.array(object_.matrix_world)[:3, :3]
    turned = normals @ (np.linalg.det(matrix) * np.linalg.pinv(matrix))
    return float(np.linalg.norm(turned, axis=1).mean()) if len(turned) else 1.0


HEADER = (
    *("work_plane", "x_m", "y_m", "z_m", "normal_x", "normal_y", "normal_z"),
    *(f"{quantity}_lx" for quantity in tables.QUANTITIES),
)


def rows(scene: bpy.types.Scene, unit_scale: float) -> Iterator[tuple[str | float, ...]]:
    """Yield a row for `HEADER` for each point that was read."""
    for grid in grids(scene, unit_scale):
        mesh = scene.objects[grid.object_name].data
        names = map(writeback.attribute_of, tables.QUANTITIES)
        found = [mesh_arrays.read_face_values(mesh, name, np.float32) for name in names]
        if found[0] is not None:  # a file solved by an earlier version knows less
            known = [np.full(len(found[0]), np.nan) if values is None else values for values in found]
            for row in np.column_stack([grid.points, grid.normals, *known]).tolist():
                yield (grid.object_name, *row)


def is_stale(object_: bpy.types.Object) -> bool:
    """Whether a work plane was moved or edited since it was read."""
    state = object_.luzespecular.plane.state
    return bool(state) and state != state_of(object_)
