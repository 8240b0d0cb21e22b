"""References by brute force: the louvres and the furnished room of ``data/``, made once and kept.

    python benchmarks/brute_force.py louvres [--paths 100000] [--rays 1000000]

Nothing here is the solver's: rays in double precision against parallelograms, the sky by its formula, diffuse paths
with a fixed seed. The direct sky is sampled over the opening by the additive recurrence of Roberts (2018), eight times
with shifts of its own; what is reflected by paths that look at the opening from each place where they turn. Standard
errors are those of the mean of the eight.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scenes

BATCHES = 8
_CHUNK = 8192
_RECURRENCE = 1.1127756842787055 ** -np.arange(1.0, 7.0)  # the root of x⁷ = x + 1
SKY_ILLUMINANCE = 10_000.0
SIZE, SILL, HEAD = 3.0, 1.0, 2.5


@dataclass(frozen=True)
class Quads:
    """Parallelograms that rays may meet, backs black unless two-sided.

    Attributes
    ----------
    corners : (q, 4, 3) float [m]
    reflectance : (q,) float
    two_sided : (q,) bool
    """

    corners: np.ndarray
    reflectance: np.ndarray
    two_sided: np.ndarray

    @cached_property
    def sides(self) -> tuple[np.ndarray, np.ndarray]:
        """Two sides of each, (q, 3) each."""
        return self.corners[:, 1] - self.corners[:, 0], self.corners[:, 3] - self.corners[:, 0]

    @cached_property
    def normals(self) -> np.ndarray:
        """(q, 3) float, unit."""
        n = np.cross(*self.sides)
        return n / np.linalg.norm(n, axis=1, keepdims=True)

    @cached_property
    def duals(self) -> np.ndarray:
        """(q, 2, 3) float: vectors whose products with a place in the plane give its two coordinates, 0 … 1."""
        pairs = np.stack(self.sides, axis=1)
        return np.linalg.inv(pairs @ pairs.transpose(0, 2, 1)) @ pairs

    def first_hits(self, origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Distance to the nearest parallelogram along each ray, and which it is; infinite and -1 where none is."""
        distance, which = np.full(len(origins), np.inf), np.full(len(origins), -1)
        for start in range(0, len(origins), _CHUNK):
            rows = slice(start, start + _CHUNK)
            p, d, best, hit = origins[rows], directions[rows], distance[rows], which[rows]
            for q in range(len(self.corners)):
                n, corner = self.normals[q], self.corners[q, 0]
                with np.errstate(divide="ignore", invalid="ignore"):
                    t = (corner @ n - p @ n) / (d @ n)
                    inside = (t > 1e-9) & (t < best)
                    for dual in self.duals[q]:
                        u = (p @ dual - corner @ dual) + t * (d @ dual)
                        inside &= (u >= 0) & (u <= 1)
                np.copyto(best, t, where=inside)
                hit[inside] = q
        return distance, which


def overcast(directions: np.ndarray) -> np.ndarray:
    """Luminance of the traditional overcast sky, L = Lz (1 + 2 sin γ) / 3 (Moon & Spencer 1942) [cd/m²]."""
    zenith = 9 * SKY_ILLUMINANCE / (7 * math.pi)
    up = directions[:, 2]
    return np.where(up > 0, zenith * (1 + 2 * up) / 3, 0.0)


def cosine_directions(normals: np.ndarray, share: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Directions above planes of normals ``(m, 3)``, each as likely as its cosine."""
    helper = np.where(np.abs(normals[:, :1]) < 0.5, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    first = np.cross(helper, normals)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(normals, first)
    angle = 2 * math.pi * turn[:, None]
    level = np.cos(angle) * first + np.sin(angle) * second
    return np.sqrt(share)[:, None] * level + np.sqrt(1 - share)[:, None] * normals


@dataclass(frozen=True)
class Opening:
    """The rectangle in a wall looking north through which all light comes.

    Attributes
    ----------
    corners : (4, 3) float [m]
    """

    corners: np.ndarray

    @cached_property
    def area(self) -> float:
        """[m²]."""
        return float(np.linalg.norm(np.cross(*self.sides)))

    @property
    def sides(self) -> tuple[np.ndarray, np.ndarray]:
        """Two sides, along the wall and up."""
        return self.corners[1] - self.corners[0], self.corners[3] - self.corners[0]

    def outside(self, points: np.ndarray) -> np.ndarray:
        """Whether places (m, 3) lie beyond the wall."""
        return points[:, 1] > self.corners[0, 1] + 1e-9

    def density(self, points: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """How likely, by solid angle, a place taken evenly in the opening lies in these directions [1/sr]."""
        depth = self.corners[0, 1] - points[:, 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = depth / directions[:, 1]
            density = distance**2 / (np.abs(directions[:, 1]) * self.area)
        return np.where(directions[:, 1] > 0, density, np.inf)

    def sky(self, quads: Quads, points, normals, first, second, shared: bool) -> np.ndarray:
        """One sample of the sky's illuminance at each place, by way of a place in the opening [lx].

        Where it is shared with directions taken by their cosine, it counts by the balance heuristic (Veach 1997).
        """
        across, up = self.sides
        way = self.corners[0] + first[:, None] * across + second[:, None] * up - points
        directions = way / np.linalg.norm(way, axis=1, keepdims=True)
        cosine = np.maximum(np.einsum("mc,mc->m", directions, normals), 0.0)
        density = self.density(points, directions) + (cosine / math.pi if shared else 0.0)
        value = cosine * overcast(directions) / density
        lit = np.flatnonzero(value > 0)
        _, which = quads.first_hits(points[lit], directions[lit])
        value[lit[which >= 0]] = 0.0
        return value


def initial(quads: Quads, opening: Opening, point, normal, rays: int, rng) -> tuple[float, float]:
    """Illuminance by the sky alone, before any reflection, and its standard error [lx]."""
    number = np.arange(rays // BATCHES)[:, None] * [0.7548776662466927, 0.5698402909980532]
    shape = (len(number), 3)
    point, normal = np.broadcast_to(point, shape), np.broadcast_to(normal, shape)
    means = []
    for _ in range(BATCHES):
        place = (number + rng.random(2)) % 1
        means.append(opening.sky(quads, point, normal, *place.T, shared=False).mean())
    return float(np.mean(means)), float(np.std(means, ddof=1) / math.sqrt(BATCHES))


def reflected(quads: Quads, opening: Opening, point, normal, paths: int, rng) -> tuple[float, float]:
    """Illuminance by light that was reflected at least once, and its standard error [lx].

    Wherever a path turns within the room, it asks a place of the opening for the sky, and shares the answer with the
    direction that it goes on in; outside, that direction alone tells. After the first turn paths end by lot.
    """
    number = np.arange(paths // BATCHES)[:, None] * _RECURRENCE
    means = []
    for _ in range(BATCHES):
        lots = (number + rng.random(6)) % 1
        points = np.broadcast_to(point, (len(lots), 3)).copy()
        n = np.broadcast_to(normal, points.shape)
        directions = cosine_directions(n, lots[:, 0], lots[:, 1])
        weight = np.ones(len(lots))
        total, turns = 0.0, 0
        while len(points):
            distance, which = quads.first_hits(points, directions)
            if turns:
                escaped = np.flatnonzero(which < 0)
                away, start = directions[escaped], points[escaped]
                by_cosine = np.einsum("mc,mc->m", away, n[escaped]) / math.pi
                share = by_cosine / (by_cosine + np.where(opening.outside(start), 0.0, opening.density(start, away)))
                total += math.pi * (weight[escaped] * share * overcast(away)).sum()
            front = np.einsum("mc,mc->m", directions, quads.normals[which]) < 0
            met = np.flatnonzero((which >= 0) & (front | quads.two_sided[which]))
            rho = quads.reflectance[which[met]]
            if turns:
                met = met[rng.random(len(met)) < rho]
            else:
                weight[met] *= rho
            points = points[met] + distance[met, None] * directions[met]
            n = quads.normals[which[met]] * np.where(front[met], 1.0, -1.0)[:, None]
            points += 1e-9 * n
            weight, lots = weight[met], lots[met]
            chance = rng.random((len(met), 4)) if turns else lots[:, 2:]
            inside = np.flatnonzero(~opening.outside(points))
            sky = opening.sky(quads, points[inside], n[inside], *chance[inside, :2].T, shared=True)
            total += (weight[inside] * sky).sum()
            directions = cosine_directions(n, chance[:, 2], chance[:, 3])
            turns += 1
        means.append(total / len(number))
    return float(np.mean(means)), float(np.std(means, ddof=1) / math.sqrt(BATCHES))


def shell() -> dict[str, dict]:
    """The light-shelf room without its shelf: six walls, the north one open from sill to head."""
    s = SIZE
    corners = {
        "floor": ([(0, 0, 0), (s, 0, 0), (s, s, 0), (0, s, 0)], 0.4),
        "ceiling": ([(0, s, s), (s, s, s), (s, 0, s), (0, 0, s)], 0.6),
        "wall_west": ([(0, 0, 0), (0, s, 0), (0, s, s), (0, 0, s)], 0.5),
        "wall_east": ([(s, 0, s), (s, s, s), (s, s, 0), (s, 0, 0)], 0.5),
        "wall_south": ([(0, 0, 0), (0, 0, s), (s, 0, s), (s, 0, 0)], 0.5),
        "sill": ([(s, s, 0), (s, s, SILL), (0, s, SILL), (0, s, 0)], 0.5),
        "lintel": ([(s, s, HEAD), (s, s, s), (0, s, s), (0, s, HEAD)], 0.5),
    }
    return {
        k: {"quads": [[list(map(float, p)) for p in quad]], "diffuse_reflectance": r}
        for k, (quad, r) in corners.items()
    }


def louvres() -> dict[str, dict]:
    """30 slats before the opening, 4 cm deep, 5 cm apart, sloping down outwards by 20°."""
    depth, pitch, slope = 0.04, 0.05, math.radians(20)
    slats = []
    for k in range(30):
        z = SILL + (k + 0.5) * pitch
        y, drop = SIZE + 0.01 + depth * math.cos(slope), depth * math.sin(slope)
        quad = [(0, SIZE + 0.01, z), (SIZE, SIZE + 0.01, z), (SIZE, y, z - drop), (0, y, z - drop)]
        slats.append([[round(float(x), 9) for x in p] for p in quad])
    return shell() | {"slats": {"quads": slats, "diffuse_reflectance": 0.6, "two_sided": True}}


def box(x0, y0, z0, x1, y1, z1, without: str = "") -> list:
    """Outside of a box: its quads but those named (of ``-x +x -y +y -z +z``)."""
    sides = {
        "-x": [(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)],
        "+x": [(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)],
        "-y": [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)],
        "+y": [(x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0)],
        "-z": [(x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0)],
        "+z": [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)],
    }
    return [
        [[round(float(c), 9) for c in p] for p in quad] for key, quad in sides.items() if key not in without.split()
    ]


def legs(x0, y0, x1, y1, height, width) -> list:
    """Four legs from the floor to a slab; neither their feet nor their heads are seen."""
    places = [(x, y) for x in (x0, x1 - width) for y in (y0, y1 - width)]
    return [quad for x, y in places for quad in box(x, y, 0, x + width, y + width, height, "-z +z")]


def furniture() -> dict[str, dict]:
    """A table, four chairs and a bookcase."""
    table = box(0.9, 1.0, 0.72, 2.1, 1.8, 0.75) + legs(0.9, 1.0, 2.1, 1.8, 0.72, 0.05)
    chairs = []
    for x in (1.0, 1.6):
        for y, back in ((0.55, 0.55), (1.85, 2.26)):
            chairs += box(x, y, 0.42, x + 0.4, y + 0.45, 0.45) + legs(x, y, x + 0.4, y + 0.45, 0.42, 0.04)
            chairs += box(x, back, 0.5, x + 0.4, back + 0.04, 0.9)
            chairs += box(x, back, 0.45, x + 0.03, back + 0.04, 0.5, "-z +z")
            chairs += box(x + 0.37, back, 0.45, x + 0.4, back + 0.04, 0.5, "-z +z")
    case = [quad for z in (0.05, 0.45, 0.85, 1.25, 1.65) for quad in box(0.1, 0.64, z, 0.4, 1.76, z + 0.03, "-y +y")]
    case += box(0.1, 0.6, 0.0, 0.4, 0.64, 1.8, "-z") + box(0.1, 1.76, 0.0, 0.4, 1.8, 1.8, "-z")
    parts = {"table": (table, 0.45), "chairs": (chairs, 0.6), "bookcase": (case, 0.3)}
    return {key: {"quads": quads, "diffuse_reflectance": rho} for key, (quads, rho) in parts.items()}


def sensors() -> tuple[np.ndarray, np.ndarray]:
    """Places on floor, ceiling and two walls, on nothing that stands in the room."""
    floor = [(x, y, 0.0) for x in (0.5, 1.5) for y in (0.25, 1.4, 2.7)]
    ceiling = [(1.5, y, SIZE) for y in (0.25, 0.55, 1.5, 2.45, 2.7)]
    east = [(SIZE, y, z) for y in (0.4, 1.5, 2.6) for z in (0.7, 1.9)]
    south = [(0.8, 0.0, z) for z in (0.3, 1.1, 1.9)]
    sides = ((floor, (0, 0, 1)), (ceiling, (0, 0, -1)), (east, (-1, 0, 0)), (south, (0, 1, 0)))
    points = [point for places, _ in sides for point in places]
    return np.array(points), np.array([normal for places, normal in sides for _ in places], float)


ROOMS = {
    "louvres": (louvres, "façade with louvres: 30 slats of 4 cm before the seed room's opening", 0.01),
    "furnished": (
        lambda: shell() | furniture(),
        "furnished room: table, four chairs and a bookcase in the seed room's shell",
        0.02,
    ),
}


def quads_of(surfaces: dict[str, dict]) -> Quads:
    """Every parallelogram of a room."""
    rows = [(q, s["diffuse_reflectance"], s.get("two_sided", False)) for s in surfaces.values() for q in s["quads"]]
    corners, reflectance, two_sided = zip(*rows, strict=True)
    return Quads(np.array(corners), np.array(reflectance), np.array(two_sided))


def reference(name: str, rays: int, paths: int, seed: int) -> None:
    """Find the illuminances of one room and write its file."""
    make, title, max_area = ROOMS[name]
    surfaces = make()
    quads = quads_of(surfaces)
    opening = Opening(np.array([(0, SIZE, SILL), (SIZE, SIZE, SILL), (SIZE, SIZE, HEAD), (0, SIZE, HEAD)], float))
    rng = np.random.default_rng(seed)
    points, normals = sensors()
    rows = []
    for point, normal in zip(points, normals, strict=True):
        direct = initial(quads, opening, point, normal, rays, rng)
        more = reflected(quads, opening, point, normal, paths, rng)
        rows.append((*direct, direct[0] + more[0], math.hypot(direct[1], more[1])))
    light = {"sky": {"type": 16, "options": {"horizontal_illuminance": SKY_ILLUMINANCE}}}
    direct, total = np.array(rows)[:, :2], np.array(rows)[:, 2:]
    lit = direct[:, 0] > 0
    everywhere = np.ones(len(points), bool)
    measures = [
        {
            "label": f"overcast, {what}",
            "light": light,
            "initial": what != "all orders",
            "points": points[which].tolist(),
            "normals": normals[which].tolist(),
            "lux": [float(f"{v:.6g}") for v in values[which, 0]],
            "standard_error": [float(f"{v:.3g}") for v in values[which, 1]],
        }
        for what, which, values in (("sky component", lit, direct), ("all orders", everywhere, total))
    ]
    origin = f"brute force of benchmarks/brute_force.py: {rays:,} rays and {paths:,} paths a place, seed {seed}"
    scenes.write(name, title, origin, surfaces, max_area, measures)


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("room", choices=ROOMS)
    ap.add_argument("--rays", type=int, default=1_000_000, help="rays to the opening, for each place")
    ap.add_argument("--paths", type=int, default=100_000, help="paths for what is reflected, for each place")
    ap.add_argument("--seed", type=int, default=2026)
    args = ap.parse_args()
    reference(args.room, args.rays, args.paths, args.seed)


if __name__ == "__main__":
    main()
