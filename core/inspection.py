"""Inspection: what a user should know of a scene before light is computed in it.

Geometry and materials are looked at one by one; then some thousand rays tell what the surfaces' fronts and backs look
at. What is found is told with a remedy, never mended.
"""

from __future__ import annotations

import logging

import numpy as np

from . import flaws, gaps, looks, polygons
from .errors import SceneError
from .flaws import ERROR, Finding, warning
from .planes import Planes, find_planes
from .rays import RayScene
from .scene import Scene, Surface

logger = logging.getLogger(__name__)

_TOLERANCE = 1e-6
"""Of the scene's size: what is smaller counts as rounding."""

_TOLD = 10
_BRIGHT = 0.95
_LARGE, _IN_MILLIMETRES, _SMALL = 100.0, 800.0, 0.05
_LOST_DIGITS = 1e-8
_TINY, _THIN = 1e-5, 1e-5
_COSTLY_COUNT, _COSTLY_AREA = 2_000, 1e-3
_NEXT_TO_SLIT = 4.0


def check(scene: Scene) -> tuple[Finding, ...]:
    """What is wrong or odd in a scene, errors first.

    Looks for normals that are inverted or turned over, gaps where light leaks, one-sided walls seen from behind, faces
    that overlap, are not flat, have no area or are tiny, wrong units, spaces without an opening, materials without
    settings, reflectances that no paint or mirror has, panes drawn as solids or without a hole in the wall, and
    chains of mirrors that cost much.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    tuple of Finding
        Each with severity, surface, faces and remedy. `prepare` refuses a scene with errors; `Result.notes` has the
        warnings.

    Raises
    ------
    SceneError
        Where ``scene`` is no Scene.
    """
    if not isinstance(scene, Scene):
        raise SceneError(f"check needs a luzespecular.Scene, not {type(scene).__name__}")
    if not scene.surfaces:
        return (
            warning(
                "empty",
                {},
                "The scene has no surfaces",
                "add at least one with scene.add(name, vertices, material)",
                ERROR,
            ),
        )
    return inspect(scene, find_planes(scene))


def inspect(scene: Scene, planes: Planes) -> tuple[Finding, ...]:
    """Findings about a scene whose planes are known; see `check`."""
    surfaces = list(scene.surfaces.values())
    tolerance = _TOLERANCE * planes.size
    found = [finding for surface in surfaces for finding in flaws.mesh_flaws(surface)]
    found += _materials(surfaces)
    found += _sizes(surfaces, planes)
    found += flaws.thick_panes(surfaces, planes)
    normals = planes.sheet_normal[planes.outline_sheet]
    offsets = np.einsum("oc,oc->o", normals, planes.outlines[:, 0])
    pairs = planes.outline_sheet[flaws.overlapping_outlines(planes.outlines, normals, offsets, tolerance)]
    opposite = np.einsum("pc,pc->p", planes.sheet_normal[pairs[:, 0]], planes.sheet_normal[pairs[:, 1]]) < 0
    found += _overlaps(surfaces, planes, pairs, opposite, tolerance)
    found += _turned_neighbours(surfaces, planes, tolerance)
    rays = RayScene(planes.outlines, normals, offsets, 1e-3 * tolerance)
    found += _slits(surfaces, planes, gaps.find_gaps(planes.outlines, normals, tolerance), rays)
    first = np.full(len(planes.sheet_normal), -1)
    first[planes.outline_sheet[::-1]] = np.arange(len(planes.outlines))[::-1]
    two_sided = any(surface.two_sided for surface in surfaces)
    if not two_sided and flaws.looks_outward(
        planes.outlines, planes.outline_sheet, planes.sheet_normal, offsets[first], tolerance
    ):
        every = {surface.name: np.unique(surface.source_faces) for surface in surfaces}
        found.append(
            warning(
                "inside out",
                every,
                "All surfaces look outward and none sees another",
                "if this is a room seen from inside, turn its normals (reverse the order of the vertices)",
            )
        )
    else:
        found += looks.findings(surfaces, planes, rays, np.unique(np.sort(pairs[opposite], axis=1), axis=0))
    return tuple(sorted(found, key=lambda finding: finding.severity != ERROR))


def refuse(findings: tuple[Finding, ...]) -> None:
    """Raise `SceneError` for errors that no solve could cope with, and log warnings.

    Diffuse light without end is left to `Transfer.solve`, where ``cycles`` may bound it.
    """
    for finding in findings:
        if finding.severity == ERROR and finding.kind != looks.ENDLESS:
            raise SceneError(str(finding))
        if finding.kind not in flaws.OF_MESHES:  # which were told when the mesh was added
            logger.warning("%s", finding)


def _faces_of_sheets(planes: Planes, sheets) -> dict[str, np.ndarray]:
    """Surface -> faces as given, of some sheets."""
    concerned = {}
    for surface in np.unique(planes.sheet_surface[sheets]).tolist():
        mine = np.isin(planes.given_sheet, sheets) & (planes.sheet_surface[planes.given_sheet] == surface)
        concerned[planes.surfaces[surface]] = np.unique(planes.given_source[mine])
    return concerned


def _every_face(surface: Surface) -> dict[str, np.ndarray]:
    return {surface.name: np.unique(surface.source_faces)}


def _materials(surfaces: list[Surface]) -> list[Finding]:
    found = []
    area = np.array([polygons.areas(surface.pieces).sum() for surface in surfaces])
    diffuse = np.array([surface.material.diffuse_reflectance > 0 for surface in surfaces])
    coloured = 2 * area[diffuse].sum() > area.sum()  # else black is the rule
    for surface in surfaces:
        material = surface.material
        bare = not (
            material.is_specular or material.is_transparent or material.exitance or material.diffuse_reflectance
        )
        if bare and coloured:
            found.append(
                warning(
                    "no material",
                    _every_face(surface),
                    f"Surface '{surface.name}' is black: its material has no settings",
                    "give it a reflectance, or leave it if it is to swallow all light",
                )
            )
        bright = material.diffuse_reflectance + material.specular_reflectance
        if bright > _BRIGHT + 1e-9:
            found.append(
                warning(
                    "reflectance",
                    _every_face(surface),
                    f"Surface '{surface.name}' reflects {100 * bright:.4g} % of the light",
                    "white paint reflects some 85 %, a good mirror 95 %: check its material",
                )
            )
    return found


def _sizes(surfaces: list[Surface], planes: Planes) -> list[Finding]:
    found = []
    edges = np.linalg.norm(np.roll(planes.outlines, -1, axis=1) - planes.outlines, axis=2)
    longest = edges.max(axis=1)
    usual = float(np.median(longest))
    if usual > _LARGE and len(longest) > 1:
        unit, factor = ("millimetres", 0.001) if usual > _IN_MILLIMETRES else ("centimetres", 0.01)
        found.append(
            warning(
                "unit",
                {},
                f"The scene is {planes.size:.4g} m across and its surfaces mostly {usual:.4g} m long",
                f"if it was drawn in {unit}, scale it by {factor:g}",
            )
        )
    if planes.size < _SMALL:
        found.append(
            warning(
                "unit",
                {},
                f"The scene is {1000 * planes.size:.4g} mm across",
                "if it was drawn in another unit, scale it to metres",
            )
        )
    away = float(np.abs(planes.centre).max())
    if np.finfo(float).eps * away > _LOST_DIGITS * planes.size:
        found.append(
            warning(
                "far away",
                {},
                f"The scene lies {away:.4g} m from the origin, where coordinates have few digits left",
                "move it to the origin",
            )
        )
    area = polygons.areas(planes.given)
    side = np.linalg.norm(np.roll(planes.given, -1, axis=1) - planes.given, axis=2).max(axis=1)
    tiny = (side < _TINY * planes.size) | (area < _THIN * side**2)
    number = planes.sheet_surface[planes.given_sheet]
    for k in np.unique(number[tiny]).tolist():
        faces = np.unique(planes.given_source[tiny & (number == k)])
        found.append(
            warning(
                "tiny faces",
                {surfaces[k].name: faces},
                f"Surface '{surfaces[k].name}' has {len(faces)} faces that are tiny or thinner than a hair",
                "merge their vertices or remove them",
            )
        )
    outline_surface = planes.sheet_surface[planes.outline_sheet]
    count = np.bincount(outline_surface, minlength=len(surfaces))
    areas = np.bincount(outline_surface, weights=polygons.areas(planes.outlines), minlength=len(surfaces))
    for k in np.flatnonzero((count > _COSTLY_COUNT) & (areas < _COSTLY_AREA * areas.sum())).tolist():
        found.append(
            warning(
                "costly detail",
                _every_face(surfaces[k]),
                f"Surface '{surfaces[k].name}' has {100 * count[k] / count.sum():.0f} % of all polygons, and "
                f"{100 * areas[k] / areas.sum():.2g} % of the area",
                "simplify its mesh: it takes much time and gives little light",
            )
        )
    return found


def _overlaps(surfaces: list[Surface], planes: Planes, pairs, opposite, tolerance: float) -> list[Finding]:
    both = np.array([surface.two_sided or surface.material.is_transparent for surface in surfaces])
    # one-sided back to back: a sheet with two sides
    meeting = pairs[~opposite | both[planes.sheet_surface][pairs].any(axis=1)]
    found: list[Finding] = []
    of = planes.sheet_surface[meeting]
    every = np.unique(np.sort(of, axis=1), axis=0)
    for one, two in every[:_TOLD]:
        mine = meeting[(np.sort(of, axis=1) == [one, two]).all(axis=1)]
        concerned = _overlapping_faces(planes, mine, tolerance)
        a, b = surfaces[one], surfaces[two]
        if one == two:
            said, remedy = f"Surface '{a.name}': some of its faces lie on one another", "remove the doubles"
        elif a.material == b.material:
            said = f"Surfaces '{a.name}' and '{b.name}' lie on one another in one plane"
            remedy = "remove what is doubled"
        else:
            said = (
                f"Surfaces '{a.name}' and '{b.name}' lie on one another in one plane with different materials, so "
                "which of them light meets is not defined"
            )
            remedy = "remove one, or move them apart"
            if a.material.is_transparent != b.material.is_transparent:
                pane, wall = (a.name, b.name) if a.material.is_transparent else (b.name, a.name)
                remedy = f"cut an opening for '{pane}' into '{wall}', or move them apart"
        found.append(warning("overlap", concerned, said, remedy))
    if len(every) > _TOLD:
        said = f"{len(every) - _TOLD} more pairs of surfaces lie on one another"
        found.append(warning("overlap", {}, said, "remove what is doubled"))
    return found


def _overlapping_faces(planes: Planes, sheets, tolerance: float) -> dict[str, np.ndarray]:
    """Surface -> faces as given that overlap others, of pairs ``(p, 2)`` of sheets that do."""
    pieces = np.flatnonzero(np.isin(planes.given_sheet, sheets))
    normals = planes.sheet_normal[planes.given_sheet[pieces]]
    offsets = np.einsum("oc,oc->o", normals, planes.given[pieces, 0])
    pairs = pieces[flaws.overlapping_outlines(planes.given[pieces], normals, offsets, tolerance)]
    surfaces = np.unique(planes.sheet_surface[sheets])
    if len(surfaces) > 1:
        pairs = pairs[np.diff(planes.sheet_surface[planes.given_sheet[pairs]], axis=1)[:, 0] != 0]
    hit = np.unique(pairs)
    number = planes.sheet_surface[planes.given_sheet[hit]]
    return {planes.surfaces[k]: np.unique(planes.given_source[hit[number == k]]) for k in surfaces.tolist()}


def _turned_neighbours(surfaces: list[Surface], planes: Planes, tolerance: float) -> list[Finding]:
    """Faces of different surfaces side by side in one plane that look to opposite sides."""
    two_sided = np.array([surface.two_sided for surface in surfaces])
    if len(surfaces) < 2:
        return []
    number = planes.sheet_surface[planes.given_sheet]
    mine = np.flatnonzero(~two_sided[number])
    width = planes.given.shape[1]
    keys = gaps.point_keys(planes.given[mine].reshape(-1, 3), 4 * tolerance).reshape(len(mine), width)
    piece, corner = np.nonzero(keys != np.roll(keys, -1, axis=1))
    start, end = keys[piece, corner], keys[piece, (corner + 1) % width]
    piece = mine[piece]
    edge = start * np.uint64(3) + end
    order = np.argsort(edge, kind="stable")
    same = edge[order][1:] == edge[order][:-1]
    one, two = piece[order[:-1][same]], piece[order[1:][same]]
    normals = planes.sheet_normal[planes.given_sheet]
    flat = np.einsum("pc,pc->p", normals[one], normals[two]) < -1 + 1e-6
    flat &= number[one] != number[two]
    found = []
    for a, b in np.unique(np.sort(number[np.stack([one[flat], two[flat]], axis=1)], axis=1), axis=0)[:_TOLD].tolist():
        here = flat & np.isin(number[one], (a, b)) & np.isin(number[two], (a, b))
        pieces = np.unique(np.concatenate([one[here], two[here]]))
        concerned = {planes.surfaces[k]: np.unique(planes.given_source[pieces[number[pieces] == k]]) for k in (a, b)}
        found.append(
            warning(
                "turned over",
                concerned,
                f"Surfaces '{planes.surfaces[a]}' and '{planes.surfaces[b]}' lie side by side in one plane and look to "
                "opposite sides",
                "turn the normals of one of them",
            )
        )
    return found


def _slits(surfaces: list[Surface], planes: Planes, slits: gaps.Gaps, rays: RayScene) -> list[Finding]:
    """Gaps that nothing covers on either side."""
    open_ = np.ones(len(slits.one), bool)
    for side in (1.0, -1.0):
        outline, distance = rays.nearest(slits.places, side * slits.across)
        other = (outline != slits.one) & (outline != slits.two)
        open_ &= ~(other & (distance < _NEXT_TO_SLIT * slits.width))
    number = planes.sheet_surface[planes.outline_sheet]
    between = np.sort(np.stack([number[slits.one], number[slits.two]], axis=1), axis=1)
    found = []
    every = np.unique(between[open_], axis=0)
    for a, b in every[:_TOLD].tolist():
        mine = open_ & (between == [a, b]).all(axis=1)
        sheets = planes.outline_sheet[np.concatenate([slits.one[mine], slits.two[mine]])]
        concerned = _faces_of_sheets(planes, np.unique(sheets))
        name, other = surfaces[a].name, surfaces[b].name
        width, length = f"{1000 * slits.width[mine].max():.3g}", f"{slits.length[mine].max():.3g}"
        said = f"Within '{name}' is a gap up to {width} mm wide and {length} m long, through which light leaks"
        if a != b:
            said = (
                f"Between '{name}' and '{other}' is a gap up to {width} mm wide and {length} m long, through which "
                "light leaks"
            )
        found.append(
            warning(
                "gap",
                concerned,
                said,
                "move their edges together, or merge their vertices",
            )
        )
    if len(every) > _TOLD:
        said = f"{len(every) - _TOLD} more pairs of surfaces have gaps between them"
        found.append(warning("gap", {}, said, "move their edges together, or merge their vertices"))
    return found
