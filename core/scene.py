"""Scene: named surfaces with materials, checked when they are added."""

from __future__ import annotations

import logging
import operator
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from . import polygons, rings
from .errors import SceneError
from .materials import Material

logger = logging.getLogger(__name__)

PLANARITY = 1e-5
"""Largest departure of a vertex from its face's plane, relative to the face's size, that still counts as flat."""

_LARGEST_COORDINATE = 1e100


@dataclass(frozen=True, eq=False)
class Surface:
    """A named set of planar convex pieces of one material.

    Attributes
    ----------
    name : str
    material : Material
    two_sided : bool
        Whether the back receives, reflects and emits as well.
    pieces : (m, v, 3) float
        Convex polygons, padded by their last vertex, right-handed about their normal [m].
    counts : (m,) int
        Vertices of each piece.
    source_faces : (m,) int
        Index of the given face that each piece is a part of.
    flaws : dict of str to (faces, message, remedy)
        What was mended on the way in, and faces turned over, by the kind of the finding (see `flaws.OF_MESHES`).
    """

    name: str
    material: Material
    two_sided: bool
    pieces: np.ndarray
    counts: np.ndarray
    source_faces: np.ndarray
    flaws: dict[str, tuple[np.ndarray, str, str]] = field(default_factory=dict)

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on its flaws."""
        return tuple(f"{said}; {remedy}" for _, said, remedy in self.flaws.values())


@dataclass
class Scene:
    """Surfaces by name. A scene may grow; a transfer holds what it was prepared with."""

    surfaces: dict[str, Surface] = field(default_factory=dict)

    def add(
        self,
        name: str,
        vertices,
        material: Material,
        *,
        faces: np.ndarray | Sequence[Sequence[int]] | None = None,
        two_sided: bool = False,
    ) -> Surface:
        """Add a surface: one planar polygon, or a mesh.

        Parameters
        ----------
        name : str
            Unique in the scene.
        vertices : (n, 3) array of float
            Corners of one planar polygon, convex or not, counter-clockwise as seen from its lit side; or, with
            ``faces``, the vertices of a mesh [m].
        material : Material
        faces : (f, 3) or (f, 4) array of int, or list of lists of int, optional
            Faces of a mesh by index into ``vertices``. Faces that are not flat are cut into triangles.
        two_sided : bool
            Let each side receive, reflect and emit by itself.

        Returns
        -------
        Surface

        Raises
        ------
        SceneError
            Where a name is taken, a coordinate is not finite, or a polygon has no area, is not flat or crosses itself.
        """
        if not isinstance(name, str) or not name.strip():
            raise SceneError(f"A surface needs a name of at least one letter, not {name!r}")
        if name in self.surfaces:
            raise SceneError(f"Surface '{name}' is in the scene already; give each surface a name of its own")
        if not isinstance(material, Material):
            raise SceneError(
                f"Surface '{name}': material must be a luzespecular.Material, not {type(material).__name__}"
            )
        points = _vertices(name, vertices, faces is not None)
        if faces is None:
            pieces, counts, source, flaws = _polygon_pieces(name, points)
        else:
            pieces, counts, source, flaws = _mesh_pieces(name, points, faces, bool(two_sided))
        surface = Surface(name, material, bool(two_sided), pieces, counts, source, flaws)
        for note in surface.notes:
            logger.warning("Surface '%s': %s", name, note)
        self.surfaces[name] = surface
        return surface


def _vertices(name: str, vertices, mesh: bool) -> np.ndarray:
    try:
        points = np.array(vertices, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise SceneError(f"Surface '{name}': vertices must be an (n, 3) array of numbers") from None
    if points.ndim != 2 or points.shape[1] != 3:
        raise SceneError(f"Surface '{name}': vertices must be an (n, 3) array, not of shape {points.shape}")
    if len(points) < 3:
        raise SceneError(
            f"Surface '{name}' has {len(points)} vertices; a {'mesh' if mesh else 'polygon'} needs at least 3"
        )
    bad = np.flatnonzero(~(np.abs(points) < _LARGEST_COORDINATE).all(axis=1))
    if len(bad):
        raise SceneError(
            f"Surface '{name}': vertex {bad[0]} is {points[bad[0]].tolist()}; mend or remove it ({len(bad)} in all)"
        )
    return points


def _polygon_pieces(name: str, points: np.ndarray):
    normal = polygons.newell_normal(points)
    size = np.ptp(points, axis=0).max()
    twice_area = np.linalg.norm(normal)
    loop3 = points - points.mean(axis=0)
    if size > 0:
        # an even bow-tie has no net area, but still a plane
        unit = normal / twice_area if twice_area > 1e-9 * size**2 else np.linalg.svd(loop3 / size)[2][2]
        off = np.abs(loop3 @ unit).max()
        basis = polygons.plane_basis(unit)
        loop = loop3 @ basis.T
        if rings.crosses_itself(loop):
            raise SceneError(
                f"Surface '{name}': the polygon's edges cross each other; split it or reorder its vertices"
            )
        if off > PLANARITY * size:
            raise SceneError(
                f"Surface '{name}' is not flat: a vertex lies {off:.3g} m off its plane; "
                "move it, or add the surface as a mesh of triangles"
            )
    if size == 0 or twice_area <= 1e-14 * size**2:
        raise SceneError(f"Surface '{name}' has no area: its vertices repeat or lie on one line; mend or remove it")
    pieces, counts, source = _flat_pieces(points, unit)
    if not _covers(pieces, float(twice_area)):
        raise SceneError(
            f"Surface '{name}': the polygon crosses itself at a corner or covers a part twice; split it or reorder its "
            "vertices"
        )
    return pieces, counts, source, {}


def _covers(pieces: np.ndarray, twice_area: float) -> bool:
    """Whether pieces have the area of the loop that they were cut from, which they have not where it meets itself."""
    return abs(2 * polygons.areas(pieces).sum() - twice_area) <= rings.SAME_AREA * twice_area


def _flat_pieces(points: np.ndarray, unit: np.ndarray):
    """Convex pieces of one flat simple polygon, keeping its own vertices to the last bit."""
    basis = polygons.plane_basis(unit)
    tolerance = 1e-9 * np.ptp(points, axis=0).max()
    origin = points.mean(axis=0)
    parts = rings.convex_parts((points - origin) @ basis.T, tolerance)
    lifted = [part @ basis + origin for part in parts]
    for part in lifted:
        for i, corner in enumerate(part):
            distance = np.abs(points - corner).max(axis=1)
            nearest = int(np.argmin(distance))
            if distance[nearest] <= 1e-6 * np.ptp(points, axis=0).max():
                part[i] = points[nearest]
    cleaned = [rings.without_flat_corners(part[None])[0][1][0] for part in lifted if len(part) > 2]
    pieces, counts = polygons.pad(cleaned)
    return pieces, counts, np.zeros(len(cleaned), np.int64)


def _mesh_pieces(name: str, points: np.ndarray, faces, two_sided: bool):
    loops_by_length = _faces_by_length(name, faces, len(points))
    pieces, counts, source, kept, kept_rows = [], [], [], [], []
    dropped: list[np.ndarray] = []
    bent: list[np.ndarray] = []
    for length, (rows, index) in sorted(loops_by_length.items()):
        corners = points[index]
        normals = polygons.newell_normal(corners)
        size = np.ptp(corners, axis=1).max(axis=1)
        twice_area = np.linalg.norm(normals, axis=1)
        sound = twice_area > 1e-14 * np.maximum(size, 1e-300) ** 2
        dropped.append(rows[~sound])
        kept.append(index[sound])
        kept_rows.append(rows[sound])
        rows, corners, size = rows[sound], corners[sound], size[sound]
        if not len(rows):
            continue
        unit = normals[sound] / twice_area[sound][:, None]
        if length == 3:
            pieces.append(corners)
            counts.append(np.full(len(rows), 3))
            source.append(rows)
            continue
        off = np.abs(np.einsum("fvc,fc->fv", corners - corners.mean(axis=1, keepdims=True), unit)).max(axis=1)
        flat = off <= PLANARITY * size
        edge = np.roll(corners, -1, axis=1) - corners
        turn = np.einsum("fvc,fc->fv", polygons.cross(edge, np.roll(edge, -1, axis=1)), unit)
        convex = flat & (turn > -1e-9 * size[:, None] ** 2).all(axis=1) & (length < 5 or _turns_once(edge, unit))
        back = np.einsum("fvc,fvc->fv", edge, np.roll(edge, -1, axis=1)) < 0
        convex &= ~(back & (np.abs(turn) <= 1e-9 * size[:, None] ** 2)).any(axis=1)
        # between corners that lie together a bend inwards would not show
        convex &= (np.linalg.norm(edge, axis=2) > 1e-8 * size[:, None]).all(axis=1)
        for some, loops in rings.without_flat_corners(corners[convex]):
            pieces.append(loops)
            counts.append(np.full(len(some), loops.shape[1]))
            source.append(rows[convex][some])
        bent.append(rows[~flat])
        each = (rows, corners, unit, flat, twice_area[sound])
        for row, polygon, normal, flat_too, around in zip(*(values[~convex] for values in each), strict=True):
            loop = (polygon - polygon[0]) @ polygons.plane_basis(normal).T
            if rings.crosses_itself(loop):
                raise SceneError(
                    f"Surface '{name}': the edges of face {row} cross each other; split it or reorder its vertices"
                )
            triangles = polygon[rings.triangulate(loop)]
            if flat_too and not _covers(triangles, around):
                raise SceneError(
                    f"Surface '{name}': face {row} crosses itself at a corner or covers a part twice; split it or "
                    "reorder its vertices"
                )
            pieces.append(triangles)
            counts.append(np.full(len(triangles), 3))
            source.append(np.full(len(triangles), row))
    flaws = {}
    total = sum(len(p) for p in pieces)
    if not total:
        raise SceneError(f"Surface '{name}' has no face with an area; mend or remove it")
    without_area, warped = np.concatenate(dropped), np.concatenate([*bent, np.zeros(0, np.int64)])
    if len(without_area):
        said = f"{len(without_area)} faces without area left out"
        flaws["no area"] = (without_area, said, "merge their vertices or remove them")
    if len(warped):
        said = f"{len(warped)} faces that are not flat cut into triangles"
        flaws["not flat"] = (warped, said, "flatten them, or cut them as you want them")
    edges, turned = (0, without_area) if two_sided else _turned_faces(kept, kept_rows, len(points))
    if edges:
        said = f"its faces look to different sides: across {edges} edges neighbours are turned over"
        flaws["turned over in a mesh"] = (turned, said, "recalculate its normals")
    return polygons.joined([p for p in pieces if len(p)]), np.concatenate(counts), np.concatenate(source), flaws


def _turned_faces(loops: list[np.ndarray], rows: list[np.ndarray], vertex_count: int) -> tuple[int, np.ndarray]:
    """Edges of exactly two faces that both walk the same way, and the faces to turn over.

    Between faces that look to one side both ways are walked. Of each connected part of the mesh the fewer are to turn.
    """
    start = np.concatenate([index.reshape(-1) for index in loops]).astype(np.int64)
    end = np.concatenate([np.roll(index, -1, axis=1).reshape(-1) for index in loops]).astype(np.int64)
    face = np.concatenate([np.repeat(of, index.shape[1]) for of, index in zip(rows, loops, strict=True)])
    real = start != end
    start, end, face = start[real], end[real], face[real]
    edge = np.minimum(start, end) * vertex_count + np.maximum(start, end)
    order = np.argsort(edge, kind="stable")
    starts = np.flatnonzero(np.diff(edge[order], prepend=-1))
    of_two = starts[np.diff(np.append(starts, len(order))) == 2]
    one, two = order[of_two], order[of_two + 1]
    same_way = (start[one] == start[two]) & (face[one] != face[two])
    if not same_way.any():
        return 0, np.zeros(0, np.int64)
    return int(same_way.sum()), _fewer_turned(face[one], face[two], same_way)


def _fewer_turned(one: np.ndarray, two: np.ndarray, turned: np.ndarray) -> np.ndarray:
    """Faces to turn over, so that neighbours agree: the fewer ones of each connected part."""
    neighbours: dict[int, list[tuple[int, bool]]] = {}
    for a, b, over in zip(one.tolist(), two.tolist(), turned.tolist(), strict=True):
        neighbours.setdefault(a, []).append((b, over))
        neighbours.setdefault(b, []).append((a, over))
    side: dict[int, bool] = {}
    found: list[int] = []
    for first in neighbours:
        if first in side:
            continue
        side[first] = False
        part = [first]
        for here in part:  # grows while it is walked
            for other, over in neighbours[here]:
                if other not in side:
                    side[other] = side[here] != over
                    part.append(other)
        over_there = [member for member in part if side[member]]
        here_too = [member for member in part if not side[member]]
        found += over_there if len(over_there) <= len(here_too) else here_too
    return np.array(sorted(found), np.int64)


def _turns_once(edge: np.ndarray, unit: np.ndarray) -> np.ndarray:
    nxt = np.roll(edge, -1, axis=1)
    angle = np.arctan2(
        np.einsum("fvc,fc->fv", polygons.cross(edge, nxt), unit), np.einsum("fvc,fvc->fv", edge, nxt)
    ).sum(axis=1)
    return angle < 3 * np.pi


def _faces_by_length(name: str, faces, vertex_count: int) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    if isinstance(faces, np.ndarray) and faces.ndim == 2:
        groups = {faces.shape[1]: (np.arange(len(faces)), faces)}
    else:
        by_length: dict[int, tuple[list, list]] = {}
        for row, face in enumerate(_face_lists(name, faces)):
            of_length = by_length.setdefault(len(face), ([], []))
            of_length[0].append(row)
            of_length[1].append(face)
        groups = {length: (np.array(rows), np.array(index)) for length, (rows, index) in by_length.items()}
    if not groups or not any(len(rows) for rows, _ in groups.values()):
        raise SceneError(f"Surface '{name}' has no faces; remove it, or leave out 'faces' to add one polygon")
    for length, (row_of, index) in groups.items():
        if length < 3:
            raise SceneError(f"Surface '{name}': face {row_of[0]} has {length} vertices; a face needs at least 3")
        if index.dtype.kind not in "iu":
            raise SceneError(f"Surface '{name}': faces must hold whole numbers, not {index.dtype}")
        bad = np.flatnonzero(((index < 0) | (index >= vertex_count)).any(axis=1))
        if len(bad):
            raise SceneError(
                f"Surface '{name}': face {row_of[bad[0]]} names a vertex outside 0 … {vertex_count - 1}; mend the face"
            )
    return groups


def _face_lists(name: str, faces) -> list[list[int]]:
    try:
        lists = [[operator.index(vertex) for vertex in face] for face in faces]
    except TypeError:
        raise SceneError(
            f"Surface '{name}': faces must hold whole numbers, in an (f, 3) or (f, 4) array or in a list for each face"
        ) from None
    return lists
