"""Single polygons: what they look like, and their convex parts."""

from __future__ import annotations

import heapq
import itertools

import numpy as np

from .polygons import areas, centroids, cross, newell_normal, plane_basis

_STRAIGHT = 1e-6
"""Sine of the angle between edges that go straight on."""


def simplify(loop, tolerance: float) -> np.ndarray:
    """Drop repeated and collinear vertices of a closed 2-D loop ``(v, 2)``."""
    p = np.asarray(loop, float)
    changed = True
    while changed and len(p) > 2:
        before, after = np.roll(p, 1, axis=0), np.roll(p, -1, axis=0)
        a, b = p - before, after - p
        length = np.linalg.norm(a, axis=1)
        turn = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        chord = np.linalg.norm(after - before, axis=1)
        straight = (np.abs(turn) <= tolerance * np.maximum(chord, tolerance)) & ((a * b).sum(axis=1) >= 0)
        drop = (length <= tolerance) | straight
        if not drop.any():
            changed = False
        else:  # never two neighbours in one pass: each judges the other's place
            keep = ~drop
            keep |= np.roll(drop, 1) & drop
            if keep.all():
                keep[np.argmax(drop)] = False
            p = p[keep]
    return p


def without_flat_corners(polygons) -> list[tuple[np.ndarray, np.ndarray]]:
    """Convex polygons without corners that repeat or lie on the line between their neighbours.

    Parameters
    ----------
    polygons : (m, v, 3) array of float

    Returns
    -------
    list of ((k,) int, (k, w, 3) float)
        Which ones, and their corners, by the number of these.
    """
    p = np.asarray(polygons, float)
    found, left = [], np.arange(len(p))
    for rounding in (_ROUNDING, 0.0):  # slivers may be as thin as that
        lost = []
        near = rounding * np.ptp(p, axis=1).max(axis=1)
        apart = np.linalg.norm(p - np.roll(p, 1, axis=1), axis=2) > near[:, None]
        for rows, loops in _with_corners(p, apart):
            before, after = loops - np.roll(loops, 1, axis=1), np.roll(loops, -1, axis=1) - loops
            height = np.linalg.norm(cross(before, after), axis=2)
            bent = height > near[rows, None] * np.linalg.norm(before + after, axis=2)
            bent |= np.einsum("mvc,mvc->mv", before, after) < 0
            for some, fewer in _with_corners(loops, bent):
                mine = rows[some]
                same = np.abs(areas(fewer) - areas(p[mine])) <= SAME_AREA * areas(p[mine])
                same |= rounding == 0
                found.append((left[mine[same]], fewer[same]))
                lost.append(mine[~same])
        left = left[np.concatenate([np.zeros(0, np.int64), *lost])]
        p = np.asarray(polygons, float)[left]
    return [(rows, loops) for rows, loops in found if len(rows)]


_ROUNDING = 1e-12
"""Over a polygon's size: what is nearer than this, is one."""

SAME_AREA = 1e-6
"""Relative difference of areas that are the same."""


def _with_corners(polygons: np.ndarray, kept: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Polygons ``(m, v, 3)`` with some of their corners ``(m, v)``, by the number of these."""
    count = kept.sum(axis=1)
    return [
        (rows, polygons[rows][kept[rows]].reshape(len(rows), n, 3))
        for n in np.unique(count).tolist()
        for rows in [np.flatnonzero(count == n)]
    ]


def crosses_itself(loop) -> bool:
    """Whether two edges of a closed 2-D loop ``(v, 2)`` cross properly (touching is allowed)."""
    p = np.asarray(loop, float)
    n = len(p)
    if n < 4:
        return False
    a, b = p, np.roll(p, -1, axis=0)
    scale = np.ptp(p, axis=0).max() ** 2 * 1e-12

    def side(origin, tip, point):
        return (tip[..., 0] - origin[..., 0]) * (point[..., 1] - origin[..., 1]) - (tip[..., 1] - origin[..., 1]) * (
            point[..., 0] - origin[..., 0]
        )

    for i in range(n - 2):
        c, d = a[i + 2 :], b[i + 2 :]
        if i == 0:
            c, d = c[:-1], d[:-1]
        if not len(c):
            continue
        s1, s2 = side(a[i], b[i], c), side(a[i], b[i], d)
        s3, s4 = side(c, d, a[i][None]), side(c, d, b[i][None])
        if np.any(
            (np.minimum(s1, s2) < -scale)
            & (np.maximum(s1, s2) > scale)
            & (np.minimum(s3, s4) < -scale)
            & (np.maximum(s3, s4) > scale)
        ):
            return True
    return False


def is_convex(loop, tolerance: float) -> bool:
    """Whether a counter-clockwise 2-D loop ``(v, 2)`` is convex."""
    p = np.asarray(loop, float)
    a = np.roll(p, -1, axis=0) - p
    b = np.roll(a, -1, axis=0)
    bend = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    if np.any(bend < -tolerance * np.maximum(np.linalg.norm(a, axis=1), np.linalg.norm(b, axis=1))):
        return False
    onward = (a * b).sum(axis=1)
    if np.any((np.abs(bend) <= tolerance * np.linalg.norm(a, axis=1)) & (onward < 0)):
        return False  # there and back
    return np.arctan2(bend, onward).sum() < 2 * np.pi * 1.5


def triangulate(loop) -> np.ndarray:
    """Triangles of a simple counter-clockwise 2-D loop, by ear clipping.

    Bridged holes (an edge walked both ways) are welcome.

    Parameters
    ----------
    loop : (v, 2) array of float

    Returns
    -------
    (t, 3) int, indices into the loop
    """
    p = np.asarray(loop, float)
    rest = list(range(len(p)))
    scale = max(np.ptp(p, axis=0).max(), 1e-300)
    tiny = 1e-14 * scale * scale
    triangles = []
    while len(rest) > 3:
        ids = np.array(rest)
        prev, here, nxt = p[np.roll(ids, 1)], p[ids], p[np.roll(ids, -1)]
        turn = _cross(here - prev, nxt - here)
        reflex = here[turn <= tiny]
        best = int(np.argmin(np.abs(turn)))
        if abs(turn[best]) > tiny:  # not collinear or doubled
            ears = np.flatnonzero(turn > tiny)
            roundness = turn[ears] / np.maximum(((nxt[ears] - prev[ears]) ** 2).sum(axis=1), 1e-300)
            ears = ears[np.argsort(-roundness, kind="stable")]
            # a corner exactly on an ear's outline blocks it only where no other ear is left
            free = (
                int(k)
                for margin in (-tiny, tiny, np.inf)
                for k in ears
                if not _blocked(prev[k], here[k], nxt[k], reflex, margin)
            )
            best = next(free, best)
        m = len(rest)
        triangles.append((rest[best - 1], rest[best], rest[(best + 1) % m]))
        del rest[best]
    triangles.append((rest[0], rest[1], rest[2]))
    t = np.array(triangles)
    area = _cross(p[t[:, 1]] - p[t[:, 0]], p[t[:, 2]] - p[t[:, 0]])
    return t[area > tiny]


def _blocked(a, b, c, corners, margin: float) -> bool:
    """Whether a corner other than its own lies in a triangle, by ``margin`` (twice an area) inside each edge."""
    if not len(corners) or np.isinf(margin):
        return False
    inside = (
        (_cross(b - a, corners - a) >= margin)
        & (_cross(c - b, corners - b) >= margin)
        & (_cross(a - c, corners - c) >= margin)
    )
    own = (corners == a).all(axis=1) | (corners == b).all(axis=1) | (corners == c).all(axis=1)
    return bool(np.any(inside & ~own))


def convex_parts(loop, tolerance: float) -> list[np.ndarray]:
    """Convex polygons that make up a simple counter-clockwise 2-D loop (Hertel & Mehlhorn 1983: merged triangles).

    Parameters
    ----------
    loop : (v, 2) array of float
    tolerance : float
        Length below which corners count as straight [m].

    Returns
    -------
    list of (k, 2) float arrays, counter-clockwise
    """
    p = np.asarray(loop, float)
    # where corners lie closer together than the tolerance, a bend inwards would count as none
    apart = p[np.linalg.norm(p - np.roll(p, 1, axis=0), axis=1) > tolerance]
    if abs(_signed_area(apart) - _signed_area(p)) <= SAME_AREA * abs(_signed_area(p)):
        p = apart
    if is_convex(p, tolerance):
        return [p]
    parts: list[list[int] | None] = [list(t) for t in triangulate(p)]
    owner = {edge: k for k, part in enumerate(parts) if part for edge in _edges(part)}
    waiting = list(range(len(parts)))  # a heap: always the first that has not been tried with its neighbours
    apart_for_good = set()
    while waiting:
        k = heapq.heappop(waiting)
        part = parts[k]
        for a, b in _edges(part) if part else ():
            other = owner.get((b, a), k)
            neighbour = parts[other]
            if other == k or part is None or neighbour is None or (k, other) in apart_for_good:
                continue
            i, j = part.index(b), neighbour.index(a)
            together = part[i:] + part[:i] + (neighbour[j + 1 :] + neighbour[: j + 1])[:-2]
            if not is_convex(p[together], tolerance):
                apart_for_good |= {(k, other), (other, k)}
                continue
            parts[k] = parts[other] = None
            around = {owner[(d, c)] for c, d in _edges(together) if (d, c) in owner}
            owner.update(dict.fromkeys(_edges(together), len(parts)))
            for again in (*around - {k, other}, len(parts)):
                heapq.heappush(waiting, again)
            parts.append(together)
            break
    return [simplify(p[part], tolerance) for part in parts if part]


def of_few_corners(loop, most: int) -> list[np.ndarray]:
    """A convex polygon ``(v, 3)``; where it has more than ``most`` corners, in sectors about its middle of no more."""
    p = np.asarray(loop, float)
    if len(p) <= most:
        return [p]
    middle = centroids(p[None])
    from_middle, around = p - middle, np.concatenate([p, p[:1]])
    after = np.roll(from_middle, -1, axis=0)
    turned = np.arctan2(np.linalg.norm(cross(from_middle, after), axis=1), np.einsum("vc,vc->v", from_middle, after))
    ends, turn = [0], 0.0
    for k, angle in enumerate(turned.tolist()):
        turn += angle
        if k > ends[-1] and (k - ends[-1] >= most - 2 or turn > _HALF_ROUND):
            ends.append(k)
            turn = angle
    return [np.concatenate([middle, around[a : b + 1]]) for a, b in itertools.pairwise([*ends, len(p)])]


_HALF_ROUND = 0.95 * np.pi
"""Sectors that turn less about their middle are convex."""


def welded(corners, same: float) -> tuple[np.ndarray, np.ndarray]:
    """Corners ``(n, d)`` that lie together as one.

    Parameters
    ----------
    corners : (n, d) array of float
    same : float
        Distance at which corners are one; some that lie closer stay apart.

    Returns
    -------
    first : (k,) int
        The first of each that are one.
    number : (n,) int
        Which of the ``k`` each is.
    """
    _, first, number = np.unique(np.rint(corners / same), axis=0, return_index=True, return_inverse=True)
    return first, number.reshape(-1)


def merged(pieces: list[np.ndarray]) -> list[np.ndarray]:
    """Convex pieces of one plane, joined across edges that two of them share where the two together are convex.

    Parameters
    ----------
    pieces : list of (v, 3) array of float
        All right-handed about the same normal.

    Returns
    -------
    list of (u, 3) array of float
        They cover the same.
    """
    if len(pieces) < 2:
        return pieces
    corners = np.concatenate(pieces)
    normal = sum(newell_normal(piece) for piece in pieces)
    flat = (corners - corners[0]) @ plane_basis(normal / np.linalg.norm(normal)).T
    same = 1e-7 * max(float(np.ptp(flat, axis=0).max()), 1e-300)
    first, numbers = welded(flat, same)
    places, corners = flat[first], corners[first]
    rings: list[list[int] | None] = []
    for around in np.split(numbers, np.cumsum([len(piece) for piece in pieces])[:-1]):
        rings.append([int(a) for a, b in zip(around, np.roll(around, -1), strict=True) if a != b])
    owner = {edge: k for k, ring in enumerate(rings) if ring for edge in _edges(ring)}
    waiting = list(range(len(rings)))
    while waiting:
        k = waiting.pop()
        ring = rings[k]
        for a, b in _edges(ring) if ring else ():
            other = owner.get((b, a), k)
            neighbour = rings[other]
            if other == k or neighbour is None or ring is None or (b, a) not in _edges(neighbour):
                continue
            here, there = ring.index(b), neighbour.index(a)
            joined_ring = ring[here:] + ring[:here] + (neighbour[there:] + neighbour[:there])[1:-1]
            union = _convex_ring(joined_ring, places)
            if union is None:
                continue
            rings[k], rings[other] = union, None
            owner.update(dict.fromkeys(_edges(union), k))
            waiting.append(k)
            break
    return [corners[ring] for ring in rings if ring]


def _edges(ring: list[int]) -> list[tuple[int, int]]:
    return list(zip(ring, ring[1:] + ring[:1], strict=True))


def _convex_ring(ring: list[int], places: np.ndarray) -> list[int] | None:
    """The ring without corners that lie on its edges; None where it is not convex."""
    at = places[ring]
    before, after = at - np.roll(at, 1, axis=0), np.roll(at, -1, axis=0) - at
    turn = _cross(before, after)
    scale = np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
    if (turn < -_STRAIGHT * scale).any() or len(set(ring)) < len(ring):
        return None
    kept = [corner for corner, bends in zip(ring, turn > _STRAIGHT * scale, strict=True) if bends]
    return kept if len(kept) > 2 else None


def _signed_area(loop: np.ndarray) -> float:
    x, y = (loop - loop[:1]).T if len(loop) else np.zeros((2, 0))
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def _cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
