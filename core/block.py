"""Many lights at once: skies and Suns as columns, faces or points as rows, illuminance as their product."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from .checks import checked_number
from .coefficients import Coefficients, Places, find_coefficients
from .daylight import Daylight
from .errors import SceneError
from .globe import Globe
from .options import checked_memory
from .parallel import run_parallel
from .result import checked_points
from .stages import Progress, Recorder, Stage
from .transfer import Transfer

_BLOCK_BYTES = 16e6
_LIGHTS = 64
_SKY_STEP = 1.5
"""Degrees between the places that tell a parcel's mean luminance: lux within 2e-5 mostly, and 2e-4 everywhere."""


def checked_lights(lights: Iterable[Daylight | None]) -> list[Daylight | None]:
    """Lights as a list; SceneError where one is no light."""
    many = list(lights)
    for number, light in enumerate(many):
        if light is not None and not isinstance(light, Daylight):
            raise SceneError(
                f"Light {number} must be a luzespecular.Daylight, or None for the dark, not {type(light).__name__}"
            )
    return many


@dataclass(frozen=True, eq=False)
class Lights:
    """Lights as columns, to multiply coefficients with; those whose Suns stand between the same positions together.

    Attributes
    ----------
    order : (n,) int
        Which of the lights as given each is.
    suns : (s, 3) float
        Positions of the Sun that are followed.
    position, share : (n, 4) int and float
        Which of them stand for each light's Sun, and by what share of its illuminance [lx].
    daylights : list of Daylight or None
    """

    order: np.ndarray
    suns: np.ndarray
    position: np.ndarray
    share: np.ndarray
    daylights: list[Daylight | None]

    @classmethod
    def of(cls, lights: Iterable[Daylight | None], spacing: float) -> Lights:
        """Lights with their Suns at positions that are ``spacing`` [degrees] apart; 0 = each at its own."""
        daylights = checked_lights(lights)
        strength, direction = np.zeros(len(daylights)), np.tile([0.0, 0.0, 1.0], (len(daylights), 1))
        for number, light in enumerate(daylights):
            if light is not None and light.sun is not None and light.sun.direction[2] > 0:
                strength[number], direction[number] = light.sun.normal_illuminance, light.sun.direction
        shines = np.flatnonzero(strength)
        position, share = np.zeros((len(daylights), 4), np.int64), np.zeros((len(daylights), 4))
        if spacing == 0:
            suns, own = np.unique(direction[shines], axis=0, return_inverse=True)
            position[shines, 0], share[shines, 0] = own.reshape(-1), strength[shines]
            return cls._together(suns, position, share, daylights)
        globe = Globe.cut_at_horizon(max(2, round(180.0 / spacing)))
        parcel, weight = globe.interpolation(direction[shines])
        weight = np.maximum(weight, 0.0)  # below the lowest parcels the Sun stands at their height, not beyond
        weight /= weight.sum(axis=1, keepdims=True)
        used, number = np.unique(parcel[weight > 0], return_inverse=True)
        at = np.zeros(parcel.shape, np.int64)
        at[weight > 0] = number.reshape(-1)
        position[shines], share[shines] = at, weight * strength[shines, None]
        return cls._together(globe.directions[used], position, share, daylights)

    @classmethod
    def _together(cls, suns, position, share, daylights: list[Daylight | None]) -> Lights:
        order = np.lexsort(position.T)
        return cls(order, suns, position[order], share[order], [daylights[k] for k in order.tolist()])

    def of_suns(self) -> list[tuple[slice, np.ndarray, np.ndarray]]:
        """Lights whose Suns stand between the same positions: which, these (c,), and their illuminances (c, m) [lx]."""
        if not len(self.order):
            return []
        first = np.flatnonzero(np.concatenate([[True], (np.diff(self.position, axis=0) != 0).any(axis=1)]))
        found = []
        for begin, end in zip(first.tolist(), [*first[1:].tolist(), len(self.order)], strict=True):
            used = np.flatnonzero(self.share[begin:end].any(axis=0))
            if len(used):
                share = np.ascontiguousarray(self.share[begin:end, used].T.astype(np.float32))
                found.append((slice(begin, end), self.position[begin, used], share))
        return found

    def skies(self, transfer: Transfer, parcels: np.ndarray, report: Callable[[float], None]) -> np.ndarray:
        """(k, n) float32: luminances of the sky's parcels, and of the ground [cd/m²]."""
        globe, ground = transfer.geometry.targets.globe, transfer.geometry.targets.sky_parcels
        of_sky = parcels[parcels < ground]
        count = len(of_sky)
        directions = globe.subdirections(of_sky, max(1, round(180 / globe.bands / _SKY_STEP))).reshape(-1, 3)
        out = np.zeros((len(parcels), len(self.daylights)), np.float32)

        def work(some: np.ndarray, checkpoint: Callable[[], None]) -> None:
            for number in some:
                checkpoint()
                light = self.daylights[number]
                if light is None:
                    continue
                if light.sky is not None and count:
                    out[:count, number] = light.sky.luminance(directions).reshape(count, -1).mean(axis=1)
                out[count:, number] = light.ground_luminance

        numbers = np.arange(len(self.daylights))
        tasks = [numbers[first : first + _LIGHTS] for first in range(0, len(numbers), _LIGHTS)]
        if tasks:
            run_parallel(work, tasks, transfer.threads, report)
        return out


@dataclass(frozen=True, eq=False)
class Block:
    """Illuminance of many receivers under many lights, made piece by piece.

    Attributes
    ----------
    coefficients : Coefficients
    order : (n,) int
        Which of the lights as given each of the lights here is.
    skies : (k, n) float32
        See `Lights.skies`.
    suns : list of (slice, (c,) int, (c, m) float32)
        See `Lights.of_suns`.
    stages : tuple of Stage
    """

    coefficients: Coefficients
    order: np.ndarray
    skies: np.ndarray
    suns: list[tuple[slice, np.ndarray, np.ndarray]]
    stages: tuple[Stage, ...]

    @property
    def shape(self) -> tuple[int, int]:
        """Lights and receivers."""
        return len(self.order), self.coefficients.count

    def pieces(self) -> Iterator[tuple[slice, np.ndarray]]:
        """Some receivers after others: which, and their illuminance (r, n) float32 [lx]."""
        parcels, suns = len(self.coefficients.parcels), len(self.coefficients.suns)
        step = max(1, int(_BLOCK_BYTES / (4 * max(parcels + suns + len(self.order), 1))))
        for first in range(0, self.coefficients.count, step):
            some = slice(first, min(first + step, self.coefficients.count))
            found, by_suns = self.coefficients.illuminance(some, self.skies)
            for lights, positions, share in self.suns:
                found[:, lights] += by_suns[:, positions] @ share
            found += self.coefficients.steady[some, None].astype(np.float32)
            yield some, np.maximum(found, 0.0, out=found)

    def sunlight(self, some: slice) -> tuple[np.ndarray, np.ndarray]:
        """What some receivers get of the Sun without any reflection: who ever does (m,), and (m, n) float32 [lx]."""
        by_sun = self.coefficients.by_sun[0, :, some]
        mine = np.flatnonzero(by_sun.any(axis=0))
        rows = np.ascontiguousarray(by_sun[:, mine].T)
        reaches = rows.any(axis=0)
        found = np.zeros((len(mine), len(self.order)), np.float32)
        for lights, positions, share in self.suns:
            if reaches[positions].any():
                found[:, lights] = rows[:, positions] @ share
        return some.start + mine, found


def make_block(
    transfer: Transfer,
    lights: Iterable[Daylight | None],
    *,
    points,
    normals,
    sun_spacing: float,
    memory: float | None,
    whole: bool,
    progress: Progress | None,
) -> Block:
    """See `Transfer.solve_many`; ``whole``: the caller holds the illuminance of all at once."""
    spacing = checked_number(
        sun_spacing, "sun_spacing", low=0.0, high=30.0, remedy="give degrees, 0 for each hour's own position"
    )
    memory = checked_memory(memory)
    many = Lights.of(lights, spacing)
    places = None
    if points is not None or normals is not None:
        place, normal = checked_points(points, normals)
        places = Places(place - transfer.geometry.planes.centre, normal)
    _check_memory(transfer, many, places, memory, whole)
    recorder = Recorder(progress)
    if not len(many.suns):
        recorder.skip("sun", "no Sun is up")
    with recorder.stage("unit lights", 0.0):
        coefficients = find_coefficients(
            transfer, many.suns, places, lambda done, name: recorder.report(0.6 * done, name)
        )
    if not len(coefficients.parcels):
        recorder.skip("sky", "nothing sees the sky")
    with recorder.stage("skies", 0.6):
        skies = many.skies(transfer, coefficients.parcels, lambda done: recorder.report(0.6 + 0.3 * done, "skies"))
    return Block(coefficients, many.order, skies, many.of_suns(), (*transfer.stages, *recorder.stages))


def solve_many(block: Block) -> np.ndarray:
    """(n, r) float32: all of a block [lx]."""
    out = np.empty(block.shape, np.float32)
    for some, found in block.pieces():
        out[block.order, some] = found.T
    return out


def _check_memory(transfer: Transfer, lights: Lights, places: Places | None, memory: float | None, whole: bool) -> None:
    """Refuse before work what needs more."""
    if memory is None:
        return
    targets, suns, count = transfer.geometry.targets, len(lights.suns), len(lights.daylights)
    receivers = len(transfer.geometry.reported) if places is None else len(places.points)
    columns = targets.columns + suns
    needed = 4.0 * columns * (max(len(transfer.nodes.points), receivers * (places is not None)) + count)
    needed += 8.0 * suns * (receivers + targets.patches.count) + 24.0 * targets.patches.count**2
    needed += 3 * _BLOCK_BYTES + (4.0 * count * receivers if whole else 0.0)
    if needed > memory:
        raise SceneError(
            f"{count} lights with {suns} positions of the Sun need {needed / 1e9:.2f} GB, more than the "
            f"{memory / 1e9:.2f} GB of 'memory'; give fewer lights at a time, raise sun_spacing or max_area, "
            "or allow more memory"
        )
