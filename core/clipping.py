"""Convex polygons cut by planes, and what is left of them."""

from __future__ import annotations

import numpy as np

from .polygons import following, widen


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
