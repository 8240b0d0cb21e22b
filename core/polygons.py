"""Polygons in space: orientation, convex decomposition, clipping, areas and Lambert's form factor.

Batches of convex polygons travel as ``(m, v, 3)`` arrays padded by repeating the last vertex.
"""

from __future__ import annotations

import heapq
import itertools

import numpy as np


def cross(a, b) -> np.ndarray:
    """Cross products of vectors ``(..., 3)``, several times faster than NumPy's on small arrays."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    out = np.empty(np.broadcast_shapes(a.shape, b.shape))
    out[..., 0] = a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1]
    out[..., 1] = a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2]
    out[..., 2] = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return out


def following(values, axis: int = 1) -> np.ndarray:
    """Each corner's next one along an axis, several times faster than NumPy's ``roll`` on small arrays."""
    before = (slice(None),) * axis
    return np.concatenate([values[(*before, slice(1, None))], values[(*before, slice(1))]], axis=axis)


def newell_normal(polygon) -> np.ndarray:
    """Vector along the right-hand normal of closed polygons, of twice their area (Newell's method).

    Parameters
    ----------
    polygon : (..., v, 3) array of float

    Returns
    -------
    (..., 3) float
    """
    p = np.asarray(polygon, float)
    p = p[..., 1:, :] - p[..., :1, :]
    if p.size < _FEW:  # fewer steps
        product = np.matmul(np.swapaxes(p[..., :-1, :], -1, -2), p[..., 1:, :])
        return np.stack([product[..., i, j] - product[..., j, i] for i, j in _PLANES], axis=-1)
    out = np.empty((*p.shape[:-2], 3))
    for k, (i, j) in enumerate(_PLANES):
        first, second = p[..., i], p[..., j]
        out[..., k] = np.einsum("...v,...v->...", first[..., :-1], second[..., 1:])
        out[..., k] -= np.einsum("...v,...v->...", second[..., :-1], first[..., 1:])
    return out


_PLANES = ((1, 2), (2, 0), (0, 1))
_FEW = 500
"""Coordinates up to which the number of steps counts, not what they do."""


def areas(polygons) -> np.ndarray:
    """(...) float: areas of planar polygons ``(..., v, 3)`` [m²]."""
    normal = newell_normal(polygons)
    return 0.5 * np.sqrt((normal * normal).sum(axis=-1))


def widen(polygons, width: int) -> np.ndarray:
    """(m, width, 3) float: padded polygons ``(m, v, 3)``, v ≤ width, padded further."""
    return np.concatenate([polygons, np.repeat(polygons[:, -1:], width - polygons.shape[1], axis=1)], axis=1)


def joined(batches) -> np.ndarray:
    """All padded polygons of several batches ``(m, v, 3)`` in one; at least one batch."""
    width = max(batch.shape[1] for batch in batches)
    return np.concatenate([widen(batch, width) for batch in batches])


_STRAIGHT = 1e-6
"""Sine of the angle between edges that go straight on."""

# Radon's rule for means over triangles, exact to the fifth degree: barycentric places, and shares
_NEAR, _FAR = (6 - np.sqrt(15)) / 21, (6 + np.sqrt(15)) / 21
RADON_PLACES = np.array(
    [[1 / 3] * 3] + [np.roll([1 - 2 * a, a, a], k).tolist() for a in (_NEAR, _FAR) for k in range(3)]
)
RADON_SHARES = np.repeat([9 / 40, (155 - np.sqrt(15)) / 1200, (155 + np.sqrt(15)) / 1200], [1, 3, 3])


def centroids(polygons) -> np.ndarray:
    """(m, 3) float: centroids of planar convex polygons ``(m, v, 3)``."""
    p = np.asarray(polygons, float)
    if not len(p):
        return np.zeros((0, 3))
    fan = cross(p[:, 1:-1] - p[:, :1], p[:, 2:] - p[:, :1])
    normal = fan.sum(axis=1)
    share = np.einsum("mvc,mc->mv", fan, normal) / np.maximum(np.einsum("mc,mc->m", normal, normal), 1e-300)[:, None]
    return p[:, 0] + np.einsum("mv,mvc->mc", share, p[:, 1:-1] + p[:, 2:] - 2 * p[:, :1]) / 3


def plane_basis(normal) -> np.ndarray:
    """Two unit vectors that span the plane of a normal, right-handed with it.

    Axis-parallel planes get axis-parallel vectors, so that grids align with rooms.

    Parameters
    ----------
    normal : (3,) float, unit

    Returns
    -------
    (2, 3) float
    """
    n = np.asarray(normal, float)
    helper = np.eye(3)[2] if abs(n[2]) < 0.9 else np.eye(3)[0]
    first = cross(helper, n) if abs(n[2]) < 0.9 else helper - n * n[0]
    first /= np.linalg.norm(first)
    return np.stack([first, cross(n, first)])


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


def pad(polygons: list[np.ndarray], width: int | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Stack polygons of different length by repeating their last vertex.

    Returns
    -------
    vertices : (m, v, 3) float
    counts : (m,) int
    """
    counts = np.array([len(p) for p in polygons], dtype=np.int64)
    width = width or (int(counts.max()) if len(counts) else 3)
    out = np.zeros((len(polygons), width, 3))
    for row, p in zip(out, polygons, strict=True):
        row[: len(p)] = p
        row[len(p) :] = p[-1]
    return out, counts


def clip(polygons, normal, offset=0.0) -> np.ndarray:
    """Part of each convex polygon with ``normal · x ≥ offset`` (Sutherland & Hodgman 1974).

    Parameters
    ----------
    polygons : (m, v, 3) array of float, padded
    normal : (3,) or (m, 3) array of float
    offset : float or (m,) array

    Returns
    -------
    (m, w, 3) float, padded; an empty part is one point repeated, of area 0
    """
    p = np.asarray(polygons, float)
    m, v = p.shape[:2]
    if m == 0:
        return p
    n, h = np.asarray(normal, float), np.asarray(offset, float)
    if p.size <= _FEWEST and n.ndim == 1 and h.ndim == 0:
        return _clip_few(p, n, h)
    s = p @ n if n.ndim == 1 else np.einsum("mvc,mc->mv", p, n)
    s -= h if h.ndim == 0 else h[:, None]
    inside = s >= 0
    across = np.ascontiguousarray(inside.T)  # NumPy is slow where it reduces over a short last axis
    some, every = across.any(axis=0), across.all(axis=0)
    if every.all():
        return p
    cut = np.flatnonzero(some & ~every)
    if not len(cut):
        return np.where(some[:, None, None], p, p[:, :1]) if every.any() else p[:, :1]
    if len(cut) == m:
        return _cut(p, s, inside)
    parts = _cut(p[cut], s[cut], inside[cut])
    out = np.repeat(p[:, :1], max(v if every.any() else 1, parts.shape[1]), axis=1)
    if every.any():
        out[every] = widen(p[every], out.shape[1])
    out[cut] = widen(parts, out.shape[1])
    return out


_FEWEST = 60
"""Coordinates up to which plain numbers are cut faster than arrays."""


def parted(polygons, normal, offset) -> tuple[np.ndarray, np.ndarray]:
    """Parts of convex polygons ``(m, v, 3)`` on both sides of a plane: with ``normal · x ≤ offset``, and with ``≥``."""
    if polygons.size > _FEWEST:
        return clip(polygons, -normal, -offset), clip(polygons, normal, offset)
    heights = _heights(polygons.tolist(), normal, offset)
    return _cut_few(polygons, [[-s for s in some] for some in heights]), _cut_few(polygons, heights)


def _clip_few(p, normal, offset) -> np.ndarray:
    return _cut_few(p, _heights(p.tolist(), normal, offset))


def _heights(corners: list, normal, offset) -> list[list[float]]:
    a, b, c = normal.tolist()
    h = float(offset)
    return [[a * x + b * y + c * z - h for x, y, z in some] for some in corners]


def _cut_few(p, every: list[list[float]]) -> np.ndarray:
    """As `clip`, by the heights of all corners."""
    found, width, same = [], 0, True
    for corners, heights in zip(p.tolist(), every, strict=True):
        if min(heights) >= 0:
            kept = corners
        elif max(heights) < 0:
            kept, same = corners[:1], False
        else:
            kept, same = [], False
            for here, there, s, t in zip(
                corners, corners[1:] + corners[:1], heights, heights[1:] + heights[:1], strict=True
            ):
                if s >= 0:
                    kept.append(here)
                if (s >= 0) != (t >= 0):
                    share = s / (s - t)
                    kept.append([x + (y - x) * share for x, y in zip(here, there, strict=True)])
        found.append(kept)
        width = max(width, len(kept))
    if same:
        return p
    return np.array([kept + kept[-1:] * (width - len(kept)) for kept in found])


def _cut(p, s, inside) -> np.ndarray:
    """Polygons ``(m, v, 3)`` cut by the planes that their corners stand ``s`` (m, v) above."""
    m, v = s.shape
    nxt, s_next = following(p), following(s)
    crossing = inside != (s_next >= 0)
    gap = np.where(crossing, s - s_next, 1.0)
    cut = p + (nxt - p) * (s / gap)[:, :, None]
    slots = np.empty((m, 2 * v, 3))
    slots[:, 0::2], slots[:, 1::2] = p, cut
    used = np.empty((m, 2 * v), bool)
    used[:, 0::2], used[:, 1::2] = inside, crossing
    counts = used.sum(axis=1)
    width = max(int(counts.max()), 1)
    place = np.minimum(np.arange(width), counts[:, None] - 1)
    place += (np.cumsum(counts) - counts)[:, None]
    return slots.reshape(-1, 3)[np.flatnonzero(used)[place]]


def convex_moments(corners, lines) -> np.ndarray:
    """Area and first moments of convex polygons in the plane, cut by half-planes.

    The boundary of the cut polygon is what the half-planes leave of the polygon's sides and of its chords along their
    lines (Liang & Barsky 1984), so that nothing need be sorted or joined; area and moments follow by Green's theorem.

    Parameters
    ----------
    corners : (2, v, m) float
        Counter-clockwise, padded by repeating the last. Polygons run along the last axis, so that all steps go through
        long rows.
    lines : (3, l, m) float
        ``a + b x + c y`` is positive in the half-plane; (b, c) a unit vector or nought.

    Returns
    -------
    (3, m) float
        Area, ∫ x dA, ∫ y dA.
    """
    x, y = corners
    a, b, c = lines
    across, up = following(x, 0) - x, following(y, 0) - y
    height = b[:, None] * x
    height += c[:, None] * y
    height += a[:, None]
    height[np.abs(height) < _ON_LINE] = 0.0
    after = following(height)
    begin, end, cut = _between_lines(height, after)
    total = _boundary_moments(x, y, across, up, begin, end)
    below, next_below = height < 0, after < 0
    # along each line from where the polygon's boundary leaves the half-plane to where it comes back
    crossing = below != next_below
    cut[~crossing] = 0.0
    cut_x, cut_y = cut * across, cut * up
    cut_x += x
    cut_y += y
    enters, leaves = crossing & below, crossing & next_below
    out_x, out_y = np.einsum("lvm,lvm->lm", cut_x, leaves), np.einsum("lvm,lvm->lm", cut_y, leaves)
    in_x, in_y = np.einsum("lvm,lvm->lm", cut_x, enters), np.einsum("lvm,lvm->lm", cut_y, enters)
    count = len(a)
    begin, end = np.zeros_like(out_x), np.ones_like(out_x)
    if count > 1:
        own = np.arange(count)
        # (line, chord, m)
        first = a[:, None] + b[:, None] * out_x + c[:, None] * out_y
        last = a[:, None] + b[:, None] * in_x + c[:, None] * in_y
        first[np.abs(first) < _ON_LINE] = 0.0
        last[np.abs(last) < _ON_LINE] = 0.0
        twin = (first == 0) & (last == 0)
        twin[own[:, None] >= own] = False
        first[own, own] = last[own, own] = 1.0
        begin, end, _ = _between_lines(first, last)
        if twin.any():  # of lines that coincide one counts
            twin &= b[:, None] * b + c[:, None] * c > 0
            end[twin.any(axis=0)] = 0.0
    total += _boundary_moments(out_x, out_y, in_x - out_x, in_y - out_y, begin, end)
    return total


_ON_LINE = 1e-13
"""Distance from a line below which a corner counts as lying on it; polygons are of the size of one or less."""


def _between_lines(first, last):
    """Where segments (s, m) begin and end between lines, as shares of their length, and where each line cuts them.

    ``first`` and ``last`` (l, s, m) are the heights of the segments' ends above the lines.
    """
    change = first - last
    change[change == 0] = -1e-300
    cut = first / change
    rising = change < 0
    begin = np.where(rising, cut, 0.0).max(axis=0, initial=0.0)
    end = np.where(rising, 1.0, cut).min(axis=0, initial=1.0)
    return np.minimum(begin, 1.0), np.maximum(end, 0.0), cut


def _boundary_moments(x, y, across, up, begin, end) -> np.ndarray:
    """(3, m) float: what parts of segments from (x, y) add to area and moments about the origin; all (s, m)."""
    twice = np.maximum(end - begin, 0.0)
    twice *= x * up - y * across
    middle = begin + end
    return np.stack(
        [
            0.5 * twice.sum(axis=0),
            (twice * (2 * x + middle * across)).sum(axis=0) / 6,
            (twice * (2 * y + middle * up)).sum(axis=0) / 6,
        ]
    )


def _signed_area(loop: np.ndarray) -> float:
    x, y = (loop - loop[:1]).T if len(loop) else np.zeros((2, 0))
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def _cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
