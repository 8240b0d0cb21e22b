"""One sky and Sun on a prepared transfer: initial illuminance, interreflection, and what the light added up to."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from . import polygons, radiosity, rings
from .arrays import dots, product
from .bright import Bright, Source
from .daylight import Daylight
from .errors import SceneError
from .estimate import LEAST, OF_DOUBT, relative_errors, spread_of_facets
from .form_factors import trusted
from .gather import Targets
from .geometry import Geometry
from .nodes import Nodes, settled
from .parallel import run_parallel
from .penumbra import trace_disc
from .received import Received
from .result import Result
from .sources import SourceView
from .stages import Progress, Recorder
from .sunlight import NO_SUNLIGHT, Sunlight, trace_sun
from .transfer import Transfer

EXACT_OUTLINES = 400
"""Scenes of more outlines gather luminous surfaces and sun patches by the globe, like all other light."""

_OF_LUMINOUS, _OF_SUN_PATCHES = 2.4, 1.0
"""How fine the receivers of their light alone are, over those of all light: the Sun's comes anew with every hour."""

_CLOSED = 1e-3
"""Share of luminous surfaces' light that may escape from what counts as closed."""

_FINEST = 1e-6
"""Change left to come, over all light, below which products are summed in float64."""

_SOURCE_ROWS = 256
_SOURCE_PAIRS = 32_000
"""Receivers, and pairs of these and a source, that one thread looks at together: at least, and about."""

_FOR_ONE_THREAD = 4
"""Handfuls of these up to which threads would wait for each other more than they save."""


@dataclass(frozen=True, eq=False)
class Field:
    """Light on the elements, by origin.

    Attributes
    ----------
    components : dict of str to (e,) float [lx]
    patch_exitance : (p,) float
        Reflected light that the globe gathers: all but the bright few [lm/m²].
    patch_emitted : (p,) float
        Emitted light that the globe gathers [lm/m²]; 0 where ``sources`` hold it.
    sources : list of Source
        The bright few: luminous surfaces, and sun patches as diffuse emitters.
    emitters : int
        How many of ``sources`` are luminous surfaces; the rest are sun patches.
    deep_emitted, deep_reflected : (p,) float
        Exitance of those luminous surfaces and of the sun patches, as the globe gathers it by way of more mirrors than
        ``sources`` are followed through [lm/m²].
    by_patches : (e,) float
        Illuminance whose reflection patches send out: all but sun patches [lx].
    beyond : float
        What escapes beyond the elements' mean shares: sunlight falls beside their middles, and what does not arrive
        is gone where that is known better than what is seen to stay [lm].
    adjusted : float
        What means over areas were out by before the light was made to add up, without regard to sign [lm].
    """

    components: dict[str, np.ndarray]
    patch_exitance: np.ndarray
    patch_emitted: np.ndarray
    sources: list[Source]
    emitters: int
    deep_emitted: np.ndarray
    deep_reflected: np.ndarray
    by_patches: np.ndarray
    beyond: float
    adjusted: float

    def of_cells(self, geometry: Geometry, initial: bool) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Exitance of `Geometry.cells`, and of what many mirrors show of the bright few, by the component it makes.

        Both (c,) float [lm/m²]. Within a patch reflected light is uneven as the light on its elements is; ``initial``
        leaves it out.
        """

        def on_cells(patches: np.ndarray, uneven: np.ndarray | float = 1.0) -> np.ndarray:
            return geometry.cell_means(uneven * geometry.from_patches(patches))

        sent = {"emitted": (on_cells(self.patch_emitted), on_cells(self.deep_emitted))}
        if not initial:
            mean = geometry.from_patches(geometry.patch_means(self.by_patches))
            uneven = np.divide(self.by_patches, mean, out=np.ones_like(mean), where=mean > 0)
            sent["interreflected"] = (on_cells(self.patch_exitance, uneven), on_cells(self.deep_reflected))
        return sent


def solve_light(
    transfer: Transfer,
    light: Daylight,
    *,
    tolerance: float,
    cycles: int | None,
    quick: bool,
    progress: Progress | None,
) -> Result:
    """See `Transfer.solve`."""
    _check_options(light, tolerance, cycles)
    geometry, recorder = transfer.geometry, Recorder(progress)
    exact = cycles is not None  # so many cycles are linear in light to the last digit
    count = len(geometry.element_points)
    components = {
        name: np.zeros(count) for name in ("sky_direct", "sky_specular", "sun_direct", "sun_specular", "emitted")
    }

    sky = sky_column(geometry.targets, light)
    if not transfer.sees_out:
        recorder.skip("sky", "nothing sees the sky or the ground")
    elif sky.any():
        with recorder.stage("sky", 0.0):
            for name, seen in (("sky_direct", transfer.sky_direct), ("sky_specular", transfer.sky_specular)):
                if seen.any():
                    components[name] = transfer.on_elements(np.pi * seen.times(sky, exact))
    else:
        recorder.skip("sky", "no sky and no ground light")

    sunlight = NO_SUNLIGHT
    sun = light.sun
    if sun is None or not sun.is_up or sun.normal_illuminance == 0:
        recorder.skip(
            "sun",
            "no Sun"
            if sun is None
            else "the Sun is at or below the horizon"
            if not sun.is_up
            else "the Sun gives no light",
        )
    else:
        with recorder.stage("sun", 0.05):
            sunlight, on_elements = follow_sun(
                geometry, sun, transfer.limits.cutoff, lambda: recorder.report(0.05, "sun")
            )
            components["sun_direct"], components["sun_specular"] = on_elements
        if not sunlight.patches:
            recorder.skip("sun patches", "the Sun reaches no side that receives")

    reflectance, emitted = patch_properties(geometry)
    if geometry.targets.patches.count == 0:
        recorder.skip("interreflection", "no surface reflects or emits diffusely")
        components["interreflected"] = np.zeros(count)
        none = np.zeros(0)
        field = Field(components, none, none, [], 0, none, none, np.zeros(count), 0.0, 0.0)
    else:
        with recorder.stage("interreflection", 0.1):
            bright = ([], []) if quick else bright_few(geometry, sunlight)
            field = interreflect(
                transfer, components, sunlight, bright, reflectance, emitted, tolerance, cycles, recorder
            )
    recorder.report(1.0, "solved")
    return Result.of(transfer, light, sky, sunlight, field, recorder.stages)


def follow_sun(geometry: Geometry, sun, cutoff: float, checkpoint) -> tuple[Sunlight, tuple[np.ndarray, np.ndarray]]:
    """All that the Sun lights, and what elements get straight and by mirrors, both (e,) float [lx]."""
    cuts, outlines, outline_sheet = geometry.fracture, geometry.outlines, geometry.planes.outline_sheet
    sunlight: Sunlight
    if sun.disc:
        sunlight = trace_disc(outlines, sun, cuts.elements, geometry.lit_side, outline_sheet, cutoff, checkpoint)
    else:
        sunlight = trace_sun(outlines, np.asarray(sun.direction), sun.normal_illuminance, cutoff, checkpoint)
    return sunlight, sunlight.on_elements(geometry.triangles, outline_sheet)


def sky_column(targets: Targets, light: Daylight) -> np.ndarray:
    """(c,) float: mean luminance of each sky parcel, and last the ground's [cd/m²]."""
    parcels = targets.sky_parcels
    luminance = light.sky_luminance(targets.sky_directions).reshape(parcels, -1).mean(axis=1)
    return np.append(luminance, light.ground_luminance)


def patch_properties(geometry: Geometry) -> tuple[np.ndarray, np.ndarray]:
    """Diffuse reflectance and emitted exitance of each patch, both (p,) float."""
    patch, count = geometry.targets.patches.of_element, geometry.targets.patches.count
    reflectance, emitted = np.zeros(count), np.zeros(count)
    mine = patch >= 0
    reflectance[patch[mine]] = geometry.of_elements("diffuse_reflectance")[mine]
    emitted[patch[mine]] = geometry.of_elements("exitance")[mine]
    return reflectance, emitted


def interreflect(
    transfer,
    components,
    sunlight: Sunlight,
    bright: tuple[list[Source], list[Source]],
    reflectance,
    emitted,
    tolerance,
    cycles,
    recorder,
) -> Field:
    """Add emitted and interreflected light to the components: the bright few's by themselves, the rest by the globe."""
    geometry = transfer.geometry
    exact = cycles is not None
    emitters, sunny = bright
    sun = components["sun_direct"] + components["sun_specular"]
    none, adjusted, beyond_emitted = np.zeros(len(emitted)), np.zeros(5), 0.0
    by_globe, deep_emitted, deep_reflected = none, none, none
    if emitted.any():
        if transfer.unhidden or not emitters:
            by_globe = none if emitters else emitted  # at free points the globe would err where patches do not
            found = transfer.on_elements(gather_patches(transfer, emitted, exact))
            beyond_emitted = _sum(transfer.conservation.beyond, emitted)
        else:
            deep_emitted = emitted
            found = _gather_bright(transfer, emitters, deep_emitted, _OF_LUMINOUS, exact, recorder.part(0.1, 0.4))
        components["emitted"], adjusted[0], beyond_emitted = brought_home(
            transfer, found, geometry.of_elements("exitance"), beyond_emitted, reflected=False
        )
    sky = components["sky_direct"] + components["sky_specular"]
    smooth = sky + components["emitted"]
    share = geometry.of_elements("diffuse_reflectance")
    smooth = smooth + (sunlight.blur if sunny else sun)
    if cycles == 0 or not reflectance.any():
        components["interreflected"] = np.zeros(len(sun))
        dark, out = np.zeros(len(sun)), float(np.abs(adjusted).sum())
        return Field(components, none, by_globe, emitters, len(emitters), deep_emitted, none, dark, beyond_emitted, out)
    first, beyond = np.zeros(len(sun)), 0.0
    if sunny:
        deep_reflected = reflectance * geometry.patch_means(sun - sunlight.blur)
        first = _gather_bright(transfer, sunny, deep_reflected, _OF_SUN_PATCHES, exact, recorder.part(0.4, 0.8))
        shifts = sunlight.shifts(geometry.triangles, geometry.planes.outline_sheet)
        beyond = float((geometry.areas * share * dots(transfer.slopes_of_lost, shifts)).sum())
        first, adjusted[1], beyond = brought_home(
            transfer, first, share * (sun - sunlight.blur), beyond, reflected=True
        )
    smooth, once = geometry.patch_means(smooth), geometry.patch_means(first)

    def checkpoint() -> None:
        recorder.report(0.8, "interreflection")

    finest = exact or tolerance * (1 - transfer.gain) < _FINEST
    exchange = replace(transfer.exchange, exact=finest)
    if cycles is None:
        settled = radiosity.until_settled(exchange, reflectance, smooth + once, tolerance, checkpoint, transfer.gain)
    else:
        settled = _cycles_after_first(exchange, reflectance, smooth, once, cycles, checkpoint)
    exitance = reflectance * settled
    again = np.maximum(first + transfer.on_elements(gather_patches(transfer, exitance, exact)), 0.0)
    adjusted[2:4] = transfer.conservation.missing @ exitance, transfer.conservation.beyond @ exitance
    beyond += float(adjusted[3])
    if cycles is None:
        again, adjusted[4] = settled_home(transfer, again, sun + components["emitted"] + sky, share, beyond)
    components["interreflected"] = again
    sources = [*emitters, *sunny]
    return Field(
        components,
        exitance,
        by_globe,
        sources,
        len(emitters),
        deep_emitted,
        deep_reflected,
        sum(components.values()) - (sun - sunlight.blur if sunny else 0.0),
        beyond_emitted + beyond,
        float(np.abs(adjusted).sum()),
    )


def _cycles_after_first(factors, reflectance, smooth, first, cycles: int, checkpoint) -> np.ndarray:
    """Patch illuminance whose reflection, one last cycle, makes exactly n cycles of both kinds of light.

    Smooth light needs n − 1 cycles on the patches before its last; light whose first reflection is found already, n
    − 2.
    """
    total = radiosity.by_cycles(factors, reflectance, smooth, cycles - 1, checkpoint)
    if cycles >= 2:
        total = total + radiosity.by_cycles(factors, reflectance, first, cycles - 2, checkpoint)
    return total


def bright_few(geometry: Geometry, sunlight: Sunlight) -> tuple[list[Source], list[Source]]:
    """Luminous surfaces, and sun patches on diffuse surfaces, as sources; none where there are too many outlines."""
    outlines = geometry.outlines
    emitters: list[Source] = []
    sunny: list[Source] = []
    if len(outlines.vertices) > EXACT_OUTLINES:
        return emitters, sunny
    for polygon, material, two_sided in zip(outlines.vertices, outlines.materials, outlines.two_sided, strict=True):
        if material.exitance > 0:
            emitters.append(Source(polygon, material.exitance))
            if two_sided:
                emitters.append(Source(polygon[::-1], material.exitance))
    alike: dict[tuple[int, bool, float], list[np.ndarray]] = {}
    for patch in sunlight.patches:
        if outlines.materials[patch.outline].diffuse_reflectance > 0 and (
            patch.front or outlines.two_sided[patch.outline]
        ):
            polygon = patch.polygon if patch.front else patch.polygon[::-1]
            alike.setdefault((patch.outline, patch.front, patch.illuminance), []).append(polygon)
    for (outline, _, illuminance), pieces in alike.items():
        exitance = outlines.materials[outline].diffuse_reflectance * illuminance
        whole = (polygon for polygon in rings.merged(pieces) if polygons.newell_normal(polygon).any())
        sunny += [Source(polygon, exitance) for polygon in whole]
    return emitters, sunny


def _gather_bright(
    transfer: Transfer, sources: list[Source], deep: np.ndarray, times: float, exact: bool, progress: Progress
) -> np.ndarray:
    """(e,) float: illuminance from bright polygons; by way of many mirrors, from their patches of exitance ``deep``."""
    geometry = transfer.geometry
    found = np.zeros(0)
    done = 0.0
    planes = transfer.sheet_corners
    views = SourceView.of(Bright(geometry.outlines, sources, transfer.limits), list(planes.values()))
    number = np.zeros(max(planes, default=0) + 1, np.int64)
    number[list(planes)] = np.arange(len(planes))
    together = views[0].planes

    def evaluate(nodes: Nodes, first: int) -> np.ndarray:
        nonlocal found, done
        found = np.concatenate([found, np.zeros(len(nodes.points) - first)])
        begun, share = done, 0.6 * (1.0 - done)
        plane = number[nodes.sheet[first:]]

        def work(task: tuple[int, np.ndarray], checkpoint) -> None:
            view, mine = task
            rows = first + mine
            received = Received(len(rows), geometry.outlines.tolerance)
            views[view].add(
                nodes.points[rows], plane[mine] - view * together, np.arange(len(rows)), received, checkpoint
            )
            found[rows] = received.illuminance()

        def report(part: float) -> None:
            progress(begun + share * part, "interreflection")

        handfuls = _handfuls(plane, together, len(sources))
        run_parallel(work, handfuls, 1 if len(handfuls) <= _FOR_ONE_THREAD else transfer.threads, report)
        done = begun + share
        # there is other, even light as well: where this is faint, its unevenness matters little
        return (found + found.mean())[:, None]

    nodes = settled(transfer.lattice, geometry.fracture, evaluate, times * transfer.times)
    by_many_mirrors = product(transfer.deep_factors, deep, exact)
    return nodes.on_elements(found) + _of_rows(transfer, transfer.deep_rows, by_many_mirrors)


def _handfuls(plane: np.ndarray, together: int, sources: int) -> list[tuple[int, np.ndarray]]:
    """Receivers of planes ``(r,)``, by planes: so many of these make a view; which view, and some receivers (k,)."""
    order = np.argsort(plane, kind="stable")
    view = plane[order] // together
    most = max(_SOURCE_ROWS, _SOURCE_PAIRS // sources)
    handfuls = []
    for mine in np.split(order, np.flatnonzero(np.diff(view)) + 1):
        parts = -(-len(mine) // most)
        handfuls += [(int(plane[some[0]]) // together, some) for some in np.array_split(mine, parts) if len(some)]
    return handfuls


def _of_rows(transfer: Transfer, rows: np.ndarray, illuminance: np.ndarray) -> np.ndarray:
    """(e,) float: illuminance of the elements by that of some nodes ``(k,)`` alone."""
    if not len(rows):
        return np.zeros(len(transfer.geometry.element_points))
    values = np.zeros(len(transfer.nodes.points))
    values[rows] = illuminance
    return transfer.on_elements(values)


def gather_patches(transfer: Transfer, exitance: np.ndarray, exact: bool) -> np.ndarray:
    """(m,) float: illuminance of the nodes from patches of exitance ``(p,)`` [lx]."""
    return product(transfer.form_factors, exitance, exact) + transfer.conservation.made_up(exitance)


def brought_home(
    transfer: Transfer, illuminance: np.ndarray, exitance: np.ndarray, beyond: float, reflected: bool
) -> tuple[np.ndarray, float, float]:
    """Illuminance that elements of exitance ``(e,)`` cause, made to add up; lumens out by; and what escapes ``beyond``.

    ``beyond``: lumens that escape beyond elements' mean shares. Light that is not ``reflected`` is exact and stays so
    where any of it escapes, whatever the globe tells of that.
    """
    conservation = transfer.conservation
    flux = transfer.geometry.areas * exitance
    escaping = _sum(flux, conservation.lost) + beyond
    sent = float(flux.sum()) - escaping
    landed = _sum(conservation.kept, illuminance)
    missing = sent - landed
    closed = float(escaping <= _CLOSED * sent)
    believed = missing * (trusted(escaping / max(float(flux.sum()), 1e-300)) if reflected else closed)
    home = illuminance + believed * _spread(transfer, illuminance)
    if home.min(initial=0.0) < 0:
        home = illuminance * max(landed + believed, 0.0) / max(landed, 1e-300)
    return home, missing, beyond + missing - believed


def settled_home(
    transfer: Transfer, interreflected: np.ndarray, initial: np.ndarray, share: np.ndarray, beyond: float
) -> tuple[np.ndarray, float]:
    """Interreflected light as `brought_home`, when all of it is reflected again by ``share`` (e,).

    What is out here, after patches were made to add up, is that light is uneven within them: elements know it better.
    """
    conservation, area = transfer.conservation, transfer.geometry.areas
    stays = area * share * (1 - conservation.lost)
    spread = _spread(transfer, interreflected)
    missing = _sum(stays, initial + interreflected) - beyond - _sum(conservation.kept, interreflected)
    home = interreflected + missing / max(1 - _sum(stays, spread), 1e-12) * spread
    if home.min(initial=0.0) < 0:  # too much arrived, and some are too dark to give of it: all give by what they have
        landed, leaving = _sum(conservation.kept, interreflected), _sum(stays, interreflected)
        home = interreflected * max(1 + missing / max(landed - leaving, 1e-12 * landed, 1e-300), 0.0)
    return home, missing


def _sum(some: np.ndarray, others: np.ndarray) -> float:
    """Sum of products ``(e,)``: for inner products as long as this BLAS wakes threads that then wait for work."""
    return float((some * others).sum())


def _spread(transfer: Transfer, illuminance: np.ndarray) -> np.ndarray:
    """(e,) float: illuminance for one lumen more, only where there is some already.

    Enclosures share it as they share the light that has landed: what is dark beside a bright one stays so.
    """
    conservation, parts = transfer.conservation, transfer.conservation.enclosures
    spread = np.where(illuminance > 0, transfer.spread, 0.0)
    held = parts.sums(parts.of_elements, conservation.kept * spread)
    landed = np.where(held > 0, parts.sums(parts.of_elements, conservation.kept * illuminance), 0.0)
    share = landed / max(float(landed.sum()), 1e-300)
    return spread * (share / np.maximum(held, 1e-300))[parts.of_elements]


def sampled_errors(transfer: Transfer, light: Daylight, sky: np.ndarray, field: Field, merging: bool) -> np.ndarray:
    """(e,) float: relative errors by the globe's fineness, and by the patches' if asked; 95 of 100 are about below."""
    trial, nodes, geometry = transfer.trial, transfer.nodes, transfer.geometry
    exitance = field.patch_exitance + field.patch_emitted
    from_sky = np.pi * (transfer.sky_direct.times(sky) + transfer.sky_specular.times(sky))
    ours = from_sky[trial.nodes] + product(transfer.form_factors[trial.nodes], exitance)
    finer = np.pi * product(trial.sky, sky_column(trial.targets, light))
    finer += product(trial.cells, geometry.cell_means(geometry.from_patches(exitance)))
    more = np.zeros(len(ours))
    if merging and len(exitance):
        group = geometry.targets.patches.merged(geometry.fracture.grids, geometry.fracture.element_sheet)
        areas = geometry.patch_areas
        mean = np.bincount(group, weights=areas * exitance) / np.bincount(group, weights=areas)
        more = product(trial.cells, geometry.cell_means(geometry.from_patches(exitance - mean[group])))
    points, sheet = nodes.points[trial.nodes], nodes.sheet[trial.nodes]
    return relative_errors(points, sheet, ours, finer, more, geometry.element_points, nodes.element_sheet)


def estimate_errors(transfer: Transfer, light: Daylight, sky: np.ndarray, field: Field) -> np.ndarray:
    """(e,) float: what the errors of elements' illuminances are about below, 95 of 100 of them [lx]."""
    total = sum(field.components.values())
    exact = field.components["sun_direct"] + field.components["sun_specular"] + field.components["emitted"]
    relative = sampled_errors(transfer, light, sky, field, merging=True) + OF_DOUBT * transfer.unsure
    geometry, trial = transfer.geometry, transfer.trial
    exitance = geometry.cell_means(geometry.from_patches(field.patch_exitance + field.patch_emitted))
    facets = trial.facets
    more = np.pi * product(facets.sky, sky_column(facets.targets, light)) + product(facets.cells, exitance)
    return relative * (total - exact) + LEAST * total + spread_of_facets(facets, geometry.element_surface, more)


def _check_options(light, tolerance, cycles) -> None:
    if not isinstance(light, Daylight):
        raise SceneError(
            f"solve needs a luzespecular.Daylight, not {type(light).__name__}; e.g. Daylight(sky=UniformSky(1000))"
        )
    try:
        number = float(tolerance)
    except (TypeError, ValueError):
        raise SceneError(f"tolerance must be a number, not {tolerance!r}") from None
    if not 0 < number < 1:
        raise SceneError(f"tolerance must lie between 0 and 1 (1e-4 is usual), not {tolerance!r}")
    if cycles is not None and (isinstance(cycles, bool) or not isinstance(cycles, int | np.integer) or cycles < 0):
        raise SceneError(f"cycles must be a whole number of at least 0, or None for all, not {cycles!r}")
