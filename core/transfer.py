"""Transfer: everything that geometry and materials decide, found once and used for any sky and Sun."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .blockers import frame
from .convex import ConvexRoom
from .daylight import Daylight
from .errors import SceneError
from .estimate import Trial, make_trial
from .fingerprint import Fingerprint
from .flaws import Finding
from .form_factors import Conservation, Exchange
from .geometry import Geometry
from .inspection import inspect
from .nodes import Nodes
from .options import Options, checked_scene
from .planes import find_planes
from .scene import Scene
from .sky import UniformSky
from .slopes import slopes
from .sparse import SparseRows
from .stages import Progress, Stage
from .tracing import ChainLimits

if TYPE_CHECKING:
    from .annual import Annual

LOOKING = "visibility and form factors"
"""What most of preparing goes into."""


@dataclass(frozen=True, eq=False)
class Transfer:
    """A scene's transfer of light; see `prepare`. Use `solve` for any number of lights.

    Attributes
    ----------
    geometry : Geometry
    nodes : Nodes
        The receivers, and how elements' values follow from theirs.
    lattice : Nodes
        The first of them alone, before any were added where interpolation is in doubt.
    unsure : (e,) float
        What interpolation between nodes leaves open, over all light.
    conservation : Conservation
    unhidden : bool
        Whether nothing stands in the way of anything, so that form factors to patches are exact.
    times : float
        How many times finer than usual the scene is resolved.
    form_factors : (m, p) float32
        From each node (receiver) to each patch.
    sky_direct : SparseRows (m, c)
        From each node to each sky parcel, and last to the ground; through panes, without mirrors.
    sky_specular : SparseRows (m, c)
        The same by way of mirrors; rows that were not entered see no sky in any.
    deep_factors : (j, p) float32
        The part of ``form_factors`` that comes by more mirrors than bright polygons are followed through, for the nodes
        in ``deep_rows``.
    deep_rows : (j,) int
    exchange : Exchange
        From patch to patch.
    unlit, truncated : (m,) float32
        Form factors to sides without diffuse light, and of chains cut off.
    limits : ChainLimits
    threads : int
    fingerprint : Fingerprint
        What scene and options it holds for.
    stages : tuple of Stage
    findings : tuple of Finding
        What the scene check warns of.
    """

    geometry: Geometry
    form_factors: np.ndarray
    sky_direct: SparseRows
    sky_specular: SparseRows
    deep_factors: np.ndarray
    deep_rows: np.ndarray
    exchange: Exchange
    unlit: np.ndarray
    truncated: np.ndarray
    nodes: Nodes
    lattice: Nodes
    unsure: np.ndarray
    conservation: Conservation
    unhidden: bool
    times: float
    limits: ChainLimits
    threads: int
    fingerprint: Fingerprint
    stages: tuple[Stage, ...] = field(default=())
    findings: tuple[Finding, ...] = field(default=())

    @property
    def patch_factors(self) -> np.ndarray:
        """(p, p) float: form factors from patch to patch, area-weighted means over each."""
        return self.exchange.factors

    @cached_property
    def trial(self) -> Trial:
        """A coarser look from some of the nodes, for those who ask for errors; found when first asked for."""
        return make_trial(self.geometry, self.nodes, self.limits, self.threads, self.unhidden_cells)

    @cached_property
    def unhidden_cells(self) -> ConvexRoom | None:
        """Where nothing stands in the way: what free points see of `Geometry.cells`."""
        return ConvexRoom.around(self.geometry, self.geometry.cells.patches) if self.unhidden else None

    @cached_property
    def gain(self) -> float:
        """Upper estimate of the share of the light that survives one cycle between patches."""
        from .radiosity import largest_gain
        from .solve import patch_properties

        return largest_gain(self.exchange, patch_properties(self.geometry)[0])

    @cached_property
    def spread(self) -> np.ndarray:
        """(e,) float: `Conservation.spread` on the elements."""
        return self.on_elements(self.conservation.spread)

    @cached_property
    def slopes_of_lost(self) -> np.ndarray:
        """(e, 3) float: how `Conservation.lost` changes over each element [1/m]; 0 for those in no run."""
        found = np.zeros((len(self.geometry.fracture.elements), 3))
        for grid in self.geometry.fracture.grids:
            found[grid.elements] = slopes(grid, self.conservation.lost)
        return found

    @cached_property
    def sheet_corners(self) -> dict[int, tuple[np.ndarray, np.ndarray]]:
        """Of each sheet that has elements: corners that these lie between (c, 3), and its normal."""
        cuts = self.geometry.fracture
        order = np.argsort(cuts.element_sheet, kind="stable")
        bounds = np.flatnonzero(np.diff(cuts.element_sheet[order])) + 1
        return {
            int(cuts.element_sheet[mine[0]]): (
                frame(cuts.elements[mine].reshape(-1, 3), self.geometry.element_normals[mine[0]]),
                self.geometry.element_normals[mine[0]],
            )
            for mine in np.split(order, bounds)
            if len(mine)
        }

    @cached_property
    def sees_out(self) -> bool:
        """Whether any receiver sees anything of the sky or the ground, straight or by mirrors."""
        return self.sky_direct.any() or self.sky_specular.any()

    def on_elements(self, values: np.ndarray) -> np.ndarray:
        """Values on the elements ``(e,)`` from values at the nodes ``(m,)``."""
        return self.nodes.on_elements(values)

    def errors_by_globe(self) -> np.ndarray:
        """(e,) float: relative errors that the globe's fineness causes, as estimated under an even sky."""
        from .solve import sampled_errors

        light = Daylight(sky=UniformSky(1000.0))
        result = self.solve(light, tolerance=1e-2)
        return sampled_errors(self, light, result.sky, result.field, merging=False)

    def solve(
        self,
        light,
        *,
        tolerance: float = 1e-4,
        cycles: int | None = None,
        quick: bool = False,
        progress: Progress | None = None,
    ):
        """Illuminance for one sky and Sun.

        Parameters
        ----------
        light : Daylight
        tolerance : float
            Stop when the change left to come is below this share of the mean illuminance.
        cycles : int, optional
            Exactly this many diffuse reflections instead; 0 = none.
        quick : bool
            Gather what sun patches and luminous surfaces send on by the globe, like all smooth light: several times
            faster, and a percent or two less exact, for what moves while one looks.
        progress : callable(fraction, stage_name) -> bool, optional
            True to go on, False to cancel.

        Returns
        -------
        Result

        Raises
        ------
        SceneError
            Where an option is out of range, or light multiplies without end (closed scene of reflectance 1).
        Cancelled
            Where ``progress`` says so.
        """
        from .solve import solve_light

        return solve_light(self, light, tolerance=tolerance, cycles=cycles, quick=quick, progress=progress)

    def solve_many(
        self,
        lights: Iterable[Daylight | None],
        *,
        points=None,
        normals=None,
        sun_spacing: float = 5.0,
        memory: float | None = None,
        progress: Progress | None = None,
    ) -> np.ndarray:
        """Illuminance for many skies and Suns at once, all reflections included.

        Light adds up: skies are multiplied with what each parcel of the sky gives. So are Suns with what the positions
        around them give, whose sunlight falls as exact polygons and goes on from patch to patch. docs/method.md says
        what that errs by.

        Parameters
        ----------
        lights : iterable of Daylight or None
            None = the dark: luminous surfaces alone. A Sun counts as a point, whatever its ``disc``.
        points, normals : (m, 3) array of float, optional
            Free points, as in `Result.at`; default: the faces' fronts.
        sun_spacing : float
            Degrees between the Sun's positions that are followed, between which light is interpolated; 0 = each light's
            own position.
        memory : float, optional
            Most bytes that may be held.
        progress : callable(fraction, stage_name) -> bool, optional
            True to go on, False to cancel.

        Returns
        -------
        (n, faces) or (n, m) float32 [lx]

        Raises
        ------
        SceneError
            Where an option is out of range, more memory is needed than is allowed, or light multiplies without end.
        Cancelled
            Where ``progress`` says so.
        """
        from .block import make_block, solve_many

        return solve_many(
            make_block(
                self,
                lights,
                points=points,
                normals=normals,
                sun_spacing=sun_spacing,
                memory=memory,
                whole=True,
                progress=progress,
            )
        )

    def annual(
        self,
        lights: Iterable[Daylight | None],
        *,
        hours=None,
        limits: Iterable[float] | None = None,
        points=None,
        normals=None,
        sun_spacing: float = 5.0,
        memory: float | None = None,
        progress: Progress | None = None,
    ) -> Annual:
        """Daylight of a year: hours within limits on each face or point, piece by piece in little memory.

        Parameters
        ----------
        lights : iterable of Daylight or None
            One for each hour.
        hours : (n,) array of float or bool, optional
            Hours that each light stands for, or which of them count (occupied ones); default: 1 each.
        limits : iterable of float, optional
            Illuminances to count hours by [lx]; default: 100, 300, 500, 750, 1000, 2000, 3000, which standards name.
        points, normals, sun_spacing, memory, progress
            As in `solve_many`.

        Returns
        -------
        Annual

        Raises
        ------
        SceneError, Cancelled
            As `solve_many`.
        """
        from .annual import LIMITS, count_hours, without_dark
        from .block import make_block

        many, counted = without_dark(lights, hours)
        block = make_block(
            self,
            many,
            points=points,
            normals=normals,
            sun_spacing=sun_spacing,
            memory=memory,
            whole=False,
            progress=progress,
        )
        return count_hours(self, block, counted, LIMITS if limits is None else limits, points is None)

    def with_materials(self, scene: Scene) -> Transfer:
        """The same form factors with other diffuse reflectances and exitances: nothing is looked at again.

        Parameters
        ----------
        scene : Scene
            The same surfaces in the same order; what mirrors, transmits, reflects diffusely or shines must be the
            same, and by what share they mirror and transmit.

        Returns
        -------
        Transfer
            As `prepare` would give it. With ``accuracy``, fineness stays as it was chosen for the former materials.

        Raises
        ------
        SceneError
            Where anything else differs; the message says what.
        """
        options = Options(**self.fingerprint.options)
        difference = self.fingerprint.difference(Fingerprint.of(checked_scene(scene), options))
        if difference:
            raise SceneError(f"This transfer was prepared for {difference}; prepare the scene anew")
        geometry = self.geometry.with_materials(scene)
        note = Stage(LOOKING, 0.0, "shapes, mirrors and panes are those of an earlier transfer")
        return replace(
            self,
            geometry=geometry,
            conservation=replace(self.conservation, kept=geometry.areas_kept),
            stages=(*(stage for stage in self.stages if stage.skipped and stage.name != LOOKING), note),
            findings=inspect(scene, find_planes(scene)),
        )

    def save(self, path) -> Path:
        """Write the transfer to a file, for `load` or ``prepare(scene, cache=path)``.

        Parameters
        ----------
        path : str or path
            Written aside and renamed: the file is complete or not there.

        Returns
        -------
        Path

        Raises
        ------
        OSError
            Where it cannot be written.
        """
        from .store import save_transfer

        return save_transfer(self, path)
