"""Light along random paths, surface by surface: slow and plain, and none of it uses the solver's own geometry."""

from __future__ import annotations

import numpy as np
from builders import frame

import luzespecular as luz

_LEAST = 0.1
"""Weight below which a path goes on by chance."""


class Paths:
    """A scene of diffuse surfaces, mirrors and panes, and its light: the Sun comes straight and through panes only.

    Parameters
    ----------
    scene : luz.Scene
    light : luz.Daylight
    """

    def __init__(self, scene: luz.Scene, light: luz.Daylight):
        self.light, self.surfaces = light, list(scene.surfaces.values())
        self.polygons = [
            (number, piece[:count])
            for number, surface in enumerate(self.surfaces)
            for piece, count in zip(surface.pieces, surface.counts, strict=True)
        ]
        self.normals = np.array([_normal(polygon) for _, polygon in self.polygons])
        self.size = max(float(np.abs(polygon).max()) for _, polygon in self.polygons)

    def mean(self, name: str, count: int = 100_000, back: bool = False, batches: int = 10) -> tuple[float, float]:
        """Mean illuminance of one side of a surface, and its standard error [lx]."""
        rng = np.random.default_rng(1)
        found = [self._mean(name, count // batches, back, rng) for _ in range(batches)]
        return float(np.mean(found)), float(np.std(found, ddof=1) / np.sqrt(batches))

    def _mean(self, name: str, count: int, back: bool, rng) -> float:
        number = next(k for k, surface in enumerate(self.surfaces) if surface.name == name)
        mine = [k for k, (of, _) in enumerate(self.polygons) if of == number]
        triangles = [
            (k, polygon[[0, i, i + 1]])
            for k in mine
            for polygon in [self.polygons[k][1]]
            for i in range(1, len(polygon) - 1)
        ]
        areas = np.array([np.linalg.norm(np.cross(t[1] - t[0], t[2] - t[0])) for _, t in triangles])
        chosen = rng.choice(len(triangles), count, p=areas / areas.sum())
        u, v = np.sqrt(rng.random(count)), rng.random(count)
        shares = np.stack([1 - u, u * (1 - v), u * v], axis=1)
        place = np.einsum("nk,nkc->nc", shares, np.array([t for _, t in triangles])[chosen])
        normal = self.normals[np.array([k for k, _ in triangles])[chosen]] * (-1.0 if back else 1.0)
        return float(self._gathered(place, normal, rng).mean())

    def _gathered(self, place, normal, rng) -> np.ndarray:
        """(n,) what paths from these places bring."""
        total, path, weight = np.zeros(len(place)), np.arange(len(place)), np.ones(len(place))
        total += self._sun(place, normal)
        way = _cosine(normal, rng)
        for _ in range(200):
            met, distance = self._met(place, way)
            free = met < 0
            total[path[free]] += weight[free] * np.pi * self._luminance(way[free])
            place, way, met = (place + np.where(free, 0, distance)[:, None] * way)[~free], way[~free], met[~free]
            path, weight = path[~free], weight[~free]
            normal = self.normals[met]
            cosine = np.einsum("nc,nc->n", way, normal)
            share, emitted = self._shares(met, cosine)
            total[path] += weight * emitted
            weight = weight * share.sum(axis=1)
            stays = rng.random(len(weight)) < weight / _LEAST
            weight = np.where(weight < _LEAST, _LEAST, weight)
            place, way, normal, cosine, share, path, weight = (
                values[stays] for values in (place, way, normal, cosine, share, path, weight)
            )
            if not len(path):
                break
            kind = (rng.random(len(path))[:, None] * share.sum(axis=1)[:, None] >= np.cumsum(share, axis=1)).sum(axis=1)
            facing = normal * -np.sign(cosine)[:, None]
            diffuse, mirrored = kind == 0, kind == 1
            way = np.where(mirrored[:, None], way - 2 * cosine[:, None] * normal, way)
            way[diffuse] = _cosine(facing[diffuse], rng)
            total[path[diffuse]] += weight[diffuse] * self._sun(place[diffuse], facing[diffuse])
        return total

    def _shares(self, met, cosine) -> tuple[np.ndarray, np.ndarray]:
        """(n, 3) and (n,): shares scattered, mirrored, let through; and what is emitted."""
        shares, emitted = np.zeros((len(met), 3)), np.zeros(len(met))
        for number, surface in enumerate(self.surfaces):
            mine = np.array([of for of, _ in self.polygons])[met] == number
            material, active = surface.material, (cosine[mine] < 0) | surface.two_sided
            mirrors = active | material.reflects_both_sides
            shares[mine] = np.stack(
                [
                    material.diffuse_reflectance * active,
                    material.specular_at(cosine[mine]) * mirrors,
                    material.transmittance_at(cosine[mine]),
                ],
                axis=1,
            )
            emitted[mine] = material.exitance * active
        return shares, emitted

    def _met(self, place, way) -> tuple[np.ndarray, np.ndarray]:
        """(n,) and (n,): the nearest polygon along each ray, -1 where there is none, and how far."""
        met, nearest = np.full(len(place), -1), np.full(len(place), np.inf)
        for number, (_, polygon) in enumerate(self.polygons):
            distance = self._distance(place, way, number, polygon)
            closer = distance < nearest
            met[closer], nearest[closer] = number, distance[closer]
        return met, nearest

    def _distance(self, place, way, number, polygon) -> np.ndarray:
        normal = self.normals[number]
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = ((polygon[0] - place) @ normal) / (way @ normal)
        distance[~(distance > 1e-9 * self.size)] = np.inf
        some = np.flatnonzero(distance < np.inf)
        there = place[some] + distance[some, None] * way[some]
        inside = np.ones(len(some), bool)
        for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
            inside &= (there - a) @ np.cross(normal, b - a) >= -1e-12 * self.size
        distance[some[~inside]] = np.inf
        return distance

    def _luminance(self, way) -> np.ndarray:
        out, up = np.zeros(len(way)), way[:, 2] > 0
        if self.light.sky is not None:
            out[up] = self.light.sky.luminance(way[up])
        out[~up] = self.light.ground_luminance
        return out

    def _sun(self, place, normal) -> np.ndarray:
        sun = self.light.sun
        if sun is None or not sun.is_up:
            return np.zeros(len(place))
        way = np.array(sun.direction)
        lux = sun.normal_illuminance * np.maximum(normal @ way, 0.0)
        for number, (of, polygon) in enumerate(self.polygons):
            some = np.flatnonzero(lux)
            distance = self._distance(place[some], np.broadcast_to(way, (len(some), 3)), number, polygon)
            through = float(self.surfaces[of].material.transmittance_at(way @ self.normals[number]))
            lux[some[distance < np.inf]] *= through
        return lux


def _normal(polygon) -> np.ndarray:
    normal = sum(np.cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]) for k in range(1, len(polygon) - 1))
    return normal / np.linalg.norm(normal)


def _cosine(normals, rng) -> np.ndarray:
    """Directions above planes, as likely as what each receives."""
    ways = np.zeros_like(normals)
    for normal in np.unique(normals, axis=0):
        mine = (normals == normal).all(axis=1)
        first, second = frame(normal)
        share, turn = rng.random((2, np.count_nonzero(mine), 1))
        turn = 2 * np.pi * turn
        ways[mine] = np.sqrt(share) * (np.cos(turn) * first + np.sin(turn) * second) + np.sqrt(1 - share) * normal
    return ways
