"""Geometry: a scene made ready, with everything that looking and gathering needs to know of it."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .clusters import MANY_FACETS
from .contacts import divided
from .doubles import seen_once
from .errors import SceneError
from .facets import Facets
from .fracture import Fracture, fracture
from .gather import Targets
from .globe import Globe
from .layout import Layout, breadth_of
from .outlines import Outlines
from .patches import make_patches
from .planes import Planes
from .scene import Scene
from .solids import find_solids
from .specular import GroupSight
from .sun_patches import Triangles
from .tracing import ChainLimits

PATCHES = 1_000
"""Patches that exitance is resolved in, about; runs of cells get more where light is uneven."""

_MOST_CELLS = 10_000
"""Parts of patches that free points look at, about, in scenes of more elements."""


@dataclass(frozen=True, eq=False)
class Geometry:
    """A scene made ready: planes, faces, what beams can end on.

    Attributes
    ----------
    planes : Planes
    fracture : Fracture
    lattices : list of Layout
    targets : Targets
    beams : Globe
        By which the elements' receivers look; free points look by that of the targets.
    outlines : Outlines
    surface_materials : list of Material, one per surface
    wanted : (surfaces,) bool
        Whose faces are reported.
    element_normals : (e, 3) float
    element_points : (e, 3) float, relative to the scene's centre
    """

    planes: Planes
    fracture: Fracture
    lattices: list[Layout]
    targets: Targets
    beams: Globe
    outlines: Outlines
    surface_materials: list
    wanted: np.ndarray
    element_normals: np.ndarray
    element_points: np.ndarray

    @cached_property
    def reported(self) -> np.ndarray:
        """(f,) int: faces that results hold."""
        return np.flatnonzero(self.wanted[self.fracture.face_surface])

    def faces_of(self, name: str) -> np.ndarray:
        """(k,) int: a surface's faces among the reported ones.

        Raises
        ------
        SceneError
            Where no surface has this name, or its faces were not wanted.
        """
        surfaces = self.planes.surfaces
        if name not in surfaces:
            raise SceneError(
                f"There is no surface '{name}' in this result; its surfaces are: {', '.join(surfaces[:20])}"
            )
        number = surfaces.index(name)
        if not self.wanted[number]:
            raise SceneError(f"Faces of '{name}' were not computed: prepare with it among the receivers")
        return self._faces_by_surface[number].copy()

    @cached_property
    def _faces_by_surface(self) -> list[np.ndarray]:
        """Reported faces of each surface, in ascending order."""
        surface = self.fracture.face_surface[self.reported]
        ends = np.cumsum(np.bincount(surface, minlength=len(self.planes.surfaces)))
        return np.split(np.argsort(surface, kind="stable"), ends[:-1])

    @property
    def element_surface(self) -> np.ndarray:
        """(e,) int."""
        return self.fracture.element_surface

    def of_elements(self, name: str) -> np.ndarray:
        """(e,) float: a property of the elements' materials."""
        return np.array([getattr(m, name) for m in self.surface_materials], float)[self.element_surface]

    @cached_property
    def shown(self) -> np.ndarray:
        """(e,) bool: elements that light meets: all but those of doubled sheets, which show what the others get."""
        return self.lit_side == self.fracture.element_sheet

    @cached_property
    def lit_side(self) -> np.ndarray:
        """(e,) int: the side whose light each element gets."""
        return self.planes.stands_for[self.fracture.element_sheet]

    @cached_property
    def triangles(self) -> Triangles:
        """The elements by the side whose light they get."""
        return Triangles(self.fracture.elements, self.lit_side, int(self.planes.outline_sheet.max(initial=-1)) + 1)

    @cached_property
    def areas(self) -> np.ndarray:
        """(e,) float: the elements' areas, those of doubles counted once [m²]."""
        return np.where(self.shown, self.fracture.element_areas, 0.0)

    @property
    def areas_kept(self) -> np.ndarray:
        """(e,) float: elements' areas times the share of light that mirrors and panes do not pass on [m²]."""
        shares = self.of_elements("hemispherical_absorptance") + self.of_elements("diffuse_reflectance")
        return self.areas * shares

    def patch_sums(self, values: np.ndarray) -> np.ndarray:
        """(p,) float: sums over each patch's elements of values ``(e,)``."""
        return self.targets.patches.sums(values)

    def patch_means(self, values: np.ndarray) -> np.ndarray:
        """(p,) float: means over each patch's area of elements' values ``(e,)``."""
        return self.patch_sums(self.fracture.element_areas * values) / self.patch_areas

    @cached_property
    def patch_areas(self) -> np.ndarray:
        """(p,) float [m²]."""
        return self.patch_sums(self.fracture.element_areas)

    @cached_property
    def cells(self) -> Targets:
        """What beams from free points end on: parts of patches, as small as elements where these are not too many."""
        cuts, whole = self.fracture, self.targets.patches.of_element >= 0
        count = min(np.count_nonzero(whole), _MOST_CELLS)
        cells = make_patches(
            self.planes, cuts.elements, cuts.element_sheet, whole, cuts.element_areas, count, self.lattices
        )
        return replace(self.targets, patches=replace(cells, narrow=self.targets.patches.narrow))

    def cell_means(self, values: np.ndarray) -> np.ndarray:
        """(c,) float: area-weighted means over `cells` of values ``(e,)``."""
        cells, area = self.cells.patches, self.fracture.element_areas
        return cells.sums(area * values) / cells.sums(area)

    def from_patches(self, values: np.ndarray) -> np.ndarray:
        """(e,) float: values of patches ``(p,)`` on their elements, 0 on those of none."""
        return np.append(values, 0.0)[self.targets.patches.of_element]

    def with_materials(self, scene: Scene) -> Geometry:
        """The same shapes with the materials of a scene of the same surfaces."""
        materials = [surface.material for surface in scene.surfaces.values()]
        of_outlines = [materials[k] for k in self.planes.sheet_surface[self.planes.outline_sheet]]
        return replace(self, outlines=replace(self.outlines, materials=of_outlines), surface_materials=materials)


def make_geometry(
    scene: Scene,
    planes: Planes,
    globe: Globe,
    max_area: float | None,
    times: float = 1.0,
    receivers: Collection[str] | None = None,
    beams: Globe | None = None,
) -> Geometry:
    """Cut planes into faces, elements and patches, and list the outlines with their materials, doubled ones once.

    Receivers look by ``beams``, at many facets by those of the globe. ``times`` as many faces and patches as usual are
    made, where the user gives no ``max_area``. Surfaces that are none of the ``receivers`` are cut into no faces.
    """
    surfaces = list(scene.surfaces.values())
    planes = seen_once(planes, surfaces)
    reflects = np.array([s.material.diffuse_reflectance > 0 for s in surfaces])
    emits = np.array([s.material.exitance > 0 for s in surfaces])
    # light that a black luminous surface receives goes nowhere: cut it only where the user says how fine
    cut = reflects | (emits & (max_area is not None))
    two_sided = np.array([s.two_sided for s in surfaces])
    wanted = np.array([receivers is None or s.name in receivers for s in surfaces])
    cuts = fracture(planes, cut, reflects, two_sided, max_area, times, wanted, emits)
    if len(cuts.grids) > MANY_FACETS // 2:  # cells of meshes, too many for lattices of their own
        cuts = replace(cuts, grids=tuple(grid for grid in cuts.grids if grid.rows * grid.columns > 1))
    fronts = len(planes.sheet_surface)
    breadth = breadth_of(planes)
    lattices = [Layout.of(grid, int(cuts.element_sheet[grid.first]), planes, breadth) for grid in cuts.grids]
    cuts = divided(cuts, lattices, planes)
    points = cuts.elements.mean(axis=1)
    normals = (
        planes.sheet_normal[cuts.element_sheet % fronts] * np.where(cuts.element_sheet >= fronts, -1.0, 1.0)[:, None]
    )
    active = (reflects | emits)[cuts.element_surface] & (planes.stands_for[cuts.element_sheet] == cuts.element_sheet)
    patches = make_patches(
        planes, cuts.elements, cuts.element_sheet, active, cuts.element_areas, round(PATCHES * times), lattices
    )
    outline_surface = planes.sheet_surface[planes.outline_sheet]
    outline_normals = planes.sheet_normal[planes.outline_sheet]
    offsets = np.einsum("oc,oc->o", outline_normals, planes.outlines[:, 0])
    tolerance = max(1e-10 * planes.size, 8 * float(np.finfo(float).eps) * float(np.abs(planes.centre).max()))
    facets = Facets.of(planes.outlines, outline_normals, offsets, tolerance, globe)
    solids = find_solids(planes, np.array([not s.material.is_transparent for s in surfaces]))
    outlines = Outlines(
        vertices=planes.outlines,
        normals=outline_normals,
        offsets=offsets,
        materials=[surfaces[k].material for k in outline_surface],
        two_sided=two_sided[outline_surface],
        tolerance=tolerance,
        solids=solids if facets is None else solids.having(facets.large),
        facets=facets,
    )
    return Geometry(
        planes,
        cuts,
        lattices,
        Targets.of(planes, patches, globe),
        globe if beams is None or beams.bands == globe.bands or facets is not None else beams,
        outlines,
        [s.material for s in surfaces],
        wanted,
        normals,
        points,
    )


def sight_of(geometry: Geometry, limits: ChainLimits, normal, offset: float, beams: Globe | None = None) -> GroupSight:
    """What receivers with this normal, in the plane ``normal · x = offset``, can see by some beams."""
    hemisphere = (geometry.targets.globe if beams is None else beams).hemisphere(normal)
    return GroupSight(geometry.outlines, hemisphere, offset, limits)
