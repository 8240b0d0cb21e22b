"""The method as published, to stand beside the solver: one direction per parcel, hit or miss, plain cycles.

After Claro & Pereira, "Integração da especularidade ao método da radiosidade em iluminação", sections 2.2 and 3. From
the middle of each face one ray goes through the centre of each parcel of its hemisphere; what it meets first owns the
whole parcel. At a mirror, what the mirror's own face sees in the parcel of the reflected direction is looked up, again
and again, down to a cut-off. Then cycles: each face gives its light to all that see it.

Kinder than the original in four things: parcels have their exact cosine weights, not those of their centres; the Sun is
looked for in its own direction, and fills a parcel only in mirrors; cycles go on until little is left to come, not five
times; faces are rectangles of the area asked for, which need no search for the triangle.
"""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from scenes import Surface

import luzespecular as luz

OPEN, DARK = -1, -2
_CHUNK_CELLS = 150_000
_NEAR = 1e-5
_MOST_CYCLES = 5000


@dataclass(frozen=True, eq=False)
class Faces:
    """Parallelograms cut into faces.

    Attributes
    ----------
    corners, normals : (q, 3) float
    duals : (q, 2, 3) float: products with a place in the plane give its two coordinates, 0 … 1
    cuts : (q, 2) int: faces along each side
    starts : (q + 1,) int: first face of each
    front_only : (q,) bool: halves of two-sided sheets
    diffuse, specular, exitance : (n,) float: of each face
    centres : (n, 3) float
    """

    corners: np.ndarray
    normals: np.ndarray
    duals: np.ndarray
    cuts: np.ndarray
    starts: np.ndarray
    front_only: np.ndarray
    diffuse: np.ndarray
    specular: np.ndarray
    exitance: np.ndarray
    centres: np.ndarray

    @classmethod
    def of(cls, surfaces: dict[str, Surface], max_area: float) -> Faces:
        """Cut a scene's parallelograms into faces of at most ``max_area`` [m²]."""
        quads, facts = [], []
        for surface in surfaces.values():
            own = (surface.diffuse_reflectance, surface.specular_reflectance, surface.exitance, surface.two_sided)
            for quad in surface.quads:
                sides = (quad, quad[[0, 3, 2, 1]]) if surface.two_sided else (quad,)
                quads += sides
                facts += [own] * len(sides)
        corners = np.array(quads)
        along, up = corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0]
        pairs = np.stack([along, up], axis=1)
        normals = np.cross(along, up)
        cuts = np.ceil(np.linalg.norm(pairs, axis=2) / math.sqrt(max_area) - 1e-9).astype(int)
        starts = np.concatenate(([0], np.cumsum(cuts.prod(axis=1))))
        centres = []
        for q, (m, n) in enumerate(cuts):
            u, v = np.meshgrid((np.arange(m) + 0.5) / m, (np.arange(n) + 0.5) / n, indexing="ij")
            centres.append(corners[q, 0] + u.reshape(-1, 1) * along[q] + v.reshape(-1, 1) * up[q])
        rho_d, rho_s, exitance, _ = np.repeat(np.array(facts, float), np.diff(starts), axis=0).T
        return cls(
            corners[:, 0],
            normals / np.linalg.norm(normals, axis=1, keepdims=True),
            np.linalg.inv(pairs @ pairs.transpose(0, 2, 1)) @ pairs,
            cuts,
            starts,
            np.array([f[3] for f in facts], bool),
            rho_d,
            rho_s,
            exitance,
            np.concatenate(centres),
        )

    @property
    def count(self) -> int:
        """How many faces."""
        return int(self.starts[-1])


@dataclass(frozen=True, eq=False)
class Gathered:
    """What receivers see: form factors to faces, (m, n), and the illuminance by each light, (m, lights)."""

    form_factors: np.ndarray
    sky: np.ndarray


def _sun_illuminance(light, normal: np.ndarray) -> float:
    """Illuminance by the unobstructed Sun on a plane, 0 behind it [lx]."""
    return 0.0 if light.sun is None else max(0.0, float(normal @ light.sun.direction)) * light.sun.normal_illuminance


class HitOrMiss:
    """A scene solved for several lights.

    Parameters
    ----------
    surfaces : dict of str to Surface
    lights : list of luzespecular.Daylight
    bands : int
    max_area : float [m²]
    threads : int
    tolerance : float
        Cycles end when what is left to come is below this share of the mean illuminance.
    cutoff : float
        Reflections at mirrors are followed down to this product of reflectances.
    """

    def __init__(self, surfaces, lights, *, bands, max_area, threads, tolerance=1e-4, cutoff=1e-3):
        self.globe = luz.Globe(bands)
        self.faces = Faces.of(surfaces, max_area)
        self.cutoff = cutoff
        self.lights = lights
        self.luminances = np.stack([self._luminance(light, False) for light in lights], axis=1)
        self.mirrored_luminances = np.stack([self._luminance(light, True) for light in lights], axis=1)
        self._look_into_mirrors(threads)
        everything = self._gather_faces(threads)
        self.initial = everything.sky + (everything.form_factors @ self.faces.exitance.astype(np.float32))[:, None]
        self.cycles = 0
        self.exitance = self._cycles(everything.form_factors, tolerance)

    def _luminance(self, light, with_sun: bool) -> np.ndarray:
        """(parcels,) float: luminance of the sky, and of the Sun's parcel [cd/m²]."""
        directions = self.globe.directions
        out = np.zeros(len(directions)) if light.sky is None else np.array(light.sky.luminance(directions), float)
        if with_sun and light.sun is not None:
            sun = self.globe.parcel_of(light.sun.direction)
            out[sun] += light.sun.normal_illuminance / self.globe.solid_angles[sun]
        return out

    def _look_into_mirrors(self, threads: int) -> None:
        """What each mirror's faces see in every parcel, and the parcel that each parcel is reflected into."""
        faces, globe = self.faces, self.globe
        mirrors = [q for q in range(len(faces.cuts)) if faces.specular[faces.starts[q]] > 0]
        self.mirror_row = np.full(faces.count, -1)
        self.reflected = np.zeros((len(faces.cuts), globe.count if mirrors else 0), np.int32)
        chosen = np.flatnonzero(faces.specular > 0)
        self.mirror_row[chosen] = np.arange(len(chosen))
        self.seen_in_mirrors = np.full((len(chosen), globe.count), DARK, np.int32)
        for q in mirrors:
            n = faces.normals[q]
            self.reflected[q] = globe.parcel_of(globe.directions - 2 * (globe.directions @ n)[:, None] * n)
            hemisphere = globe.hemisphere(n)

            def look(rows, hemisphere=hemisphere):
                seen = self._view(faces.centres[rows], self._centres_seen(hemisphere))
                self.seen_in_mirrors[self.mirror_row[rows][:, None], hemisphere.parcels[None]] = seen

            self._in_chunks(look, np.arange(faces.starts[q], faces.starts[q + 1]), hemisphere, threads)

    def _in_chunks(self, work, rows: np.ndarray, hemisphere, threads: int) -> None:
        step = max(1, _CHUNK_CELLS // len(hemisphere.parcels))
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(work, [rows[k : k + step] for k in range(0, len(rows), step)]))

    def _gather_faces(self, threads: int) -> Gathered:
        faces = self.faces
        out = Gathered(
            np.zeros((faces.count, faces.count), np.float32), np.zeros((faces.count, self.luminances.shape[1]))
        )
        for q in range(len(faces.cuts)):
            if faces.specular[faces.starts[q]] > 0:
                continue  # nothing is computed on mirrors
            hemisphere = self.globe.hemisphere(faces.normals[q])

            def gather(rows, hemisphere=hemisphere):
                got = self._gather(faces.centres[rows], hemisphere)
                out.form_factors[rows], out.sky[rows] = got.form_factors, got.sky

            self._in_chunks(gather, np.arange(faces.starts[q], faces.starts[q + 1]), hemisphere, threads)
        return out

    def _centres_seen(self, hemisphere) -> np.ndarray:
        """(k, 3) float: centres of parcels; where the horizon cuts one below its centre, of what is left of it."""
        directions = self.globe.directions[hemisphere.parcels]
        return np.where((directions @ hemisphere.normal > 0)[:, None], directions, hemisphere.directions)

    def _view(self, points: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """(m, k) int32: the face that each ray meets first, or OPEN, or DARK (a back)."""
        faces = self.faces
        towards = (directions @ faces.normals.T).T.astype(np.float32)
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = 1 / towards
            height = (np.einsum("qc,qc->q", faces.normals, faces.corners) - points @ faces.normals.T).astype(np.float32)
            shift = np.einsum("mqc,qdc->dqm", points[:, None] - faces.corners[None], faces.duals).astype(np.float32)
            slope = np.einsum("kc,qdc->dqk", directions, faces.duals).astype(np.float32)
            best = np.full((len(points), len(directions)), np.inf, np.float32)
            which = np.full(best.shape, -1, np.int16)
            for q in range(len(faces.cuts)):
                if np.abs(height[:, q]).max() <= _NEAR:
                    continue
                distance = height[:, q, None] * inverse[q]
                inside = (distance > _NEAR) & (distance < best)
                if faces.front_only[q]:
                    inside &= towards[q] < 0
                for d in range(2):
                    place = distance * slope[d, q] + shift[d, q][:, None]
                    inside &= np.abs(place - np.float32(0.5)) <= np.float32(0.5)
                np.copyto(best, distance, where=inside)
                which[inside] = q
        seen = np.full(best.shape, OPEN, np.int32)
        row, column = np.nonzero(which >= 0)
        q = which[row, column].astype(int)
        cell = np.empty((2, len(q)), int)
        for d in range(2):
            place = shift[d, q, row] + best[row, column] * slope[d, q, column]
            cell[d] = np.clip((place * faces.cuts[q, d]).astype(int), 0, faces.cuts[q, d] - 1)
        face = faces.starts[q] + cell[0] * faces.cuts[q, 1] + cell[1]
        seen[row, column] = np.where(towards[q, column] < 0, face, DARK)
        return seen

    def _gather(self, points: np.ndarray, hemisphere) -> Gathered:
        faces, weights = self.faces, hemisphere.weights
        count, lights = self.faces.count, self.luminances.shape[1]
        seen = self._view(points, self._centres_seen(hemisphere))
        sky = math.pi * (np.where(seen == OPEN, weights, 0.0) @ self.luminances[hemisphere.parcels])
        for k, light in enumerate(self.lights):
            illuminance = _sun_illuminance(light, hemisphere.normal)
            if illuminance > 0:
                towards_sun = np.array([light.sun.direction]) / np.linalg.norm(light.sun.direction)
                sky[:, k] += illuminance * (self._view(points, towards_sun)[:, 0] == OPEN)
        row, column = np.nonzero(seen >= 0)
        face, weight, parcel = seen[row, column], weights[column], hemisphere.parcels[column]
        found_at, found_weight = [], []
        product = np.ones(len(face))
        while len(face):
            mirror = self.mirror_row[face] >= 0
            found_at.append(row[~mirror] * count + face[~mirror])
            found_weight.append((weight * product)[~mirror])
            product = product[mirror] * faces.specular[face[mirror]]
            go = np.flatnonzero(mirror)[product >= self.cutoff]
            product = product[product >= self.cutoff]
            row, face, weight, parcel = row[go], face[go], weight[go], parcel[go]
            quad = np.searchsorted(faces.starts, face, side="right") - 1
            parcel = self.reflected[quad, parcel] if len(go) else parcel
            face = self.seen_in_mirrors[self.mirror_row[face], parcel]
            out = np.flatnonzero(face == OPEN)
            for light in range(lights):
                by_sky = math.pi * weight[out] * product[out] * self.mirrored_luminances[parcel[out], light]
                sky[:, light] += np.bincount(row[out], by_sky, minlength=len(points))
            on = face >= 0
            row, face, weight, parcel, product = row[on], face[on], weight[on], parcel[on], product[on]
        size = len(points) * count
        if not found_at:
            return Gathered(np.zeros((len(points), count), np.float32), sky)
        factors = np.bincount(np.concatenate(found_at), np.concatenate(found_weight), minlength=size)
        return Gathered(factors.reshape(len(points), count).astype(np.float32), sky)

    def _cycles(self, form_factors: np.ndarray, tolerance: float) -> np.ndarray:
        """(n, lights) float32: exitance of the faces after as many cycles as it takes."""
        reflectance = self.faces.diffuse[:, None].astype(np.float32)
        part = self.initial.astype(np.float32)
        total, last = part.copy(), np.inf
        for self.cycles in range(1, _MOST_CYCLES + 1):
            part = form_factors @ (reflectance * part)
            total += part
            amount = float(part.mean())
            ratio = min(amount / last, 0.99999) if last > 0 else 0.0
            last = amount
            if self.cycles > 1 and amount * ratio / (1 - ratio) <= tolerance * float(total.mean()):
                break
        return reflectance * total + self.faces.exitance[:, None].astype(np.float32)

    def at(self, points: np.ndarray, normals: np.ndarray, light: int, initial: bool) -> np.ndarray:
        """Illuminance at free points by one of the lights [lx].

        Parameters
        ----------
        points, normals : (m, 3) float
        light : int
            Its place among the lights.
        initial : bool
            Leave out what was reflected diffusely.

        Returns
        -------
        (m,) float
        """
        out = np.empty(len(points))
        source = self.faces.exitance if initial else self.exitance[:, light]
        _, group = np.unique(np.round(normals, 9), axis=0, return_inverse=True)
        for k in range(group.max() + 1):
            rows = np.flatnonzero(group.reshape(-1) == k)
            hemisphere = self.globe.hemisphere(normals[rows[0]])
            step = max(1, _CHUNK_CELLS // len(hemisphere.parcels))
            for some in np.split(rows, range(step, len(rows), step)):
                got = self._gather(points[some], hemisphere)
                out[some] = got.sky[:, light] + got.form_factors @ source
        return out
