"""Daylight factors on a work plane: a grid, its statistics, and the sky's and the walls' share.

A room of 6 m x 4 m x 3 m lit by one window in its south wall, under the CIE overcast sky; the work plane lies at the
height of the sill, 0.85 m, its points half a metre apart and half a metre from the walls.

    python examples/daylight_factor_grid.py
"""

import numpy as np

import luzespecular as luz

LENGTH, DEPTH, HEIGHT = 6.0, 4.0, 3.0
SILL, HEAD, LEFT, RIGHT = 0.85, 2.35, 1.5, 4.5  # the window's edges in the wall y = 0
OUTDOORS = 10_000.0  # lx


def room() -> luz.Scene:
    """Return the room: reflectances of 20 % (floor), 50 % (walls) and 70 % (ceiling)."""
    floor, wall, ceiling = (luz.Material(diffuse_reflectance=r) for r in (0.2, 0.5, 0.7))
    x, y, z = LENGTH, DEPTH, HEIGHT
    scene = luz.Scene()
    scene.add("floor", [[0, 0, 0], [x, 0, 0], [x, y, 0], [0, y, 0]], floor)
    scene.add("ceiling", [[0, y, z], [x, y, z], [x, 0, z], [0, 0, z]], ceiling)
    scene.add("wall_west", [[0, 0, 0], [0, y, 0], [0, y, z], [0, 0, z]], wall)
    scene.add("wall_east", [[x, 0, z], [x, y, z], [x, y, 0], [x, 0, 0]], wall)
    scene.add("wall_north", [[x, y, 0], [x, y, z], [0, y, z], [0, y, 0]], wall)
    for name, a, b, c, d in (
        ("sill", 0, x, 0, SILL),
        ("lintel", 0, x, HEAD, z),
        ("pier_west", 0, LEFT, SILL, HEAD),
        ("pier_east", RIGHT, x, SILL, HEAD),
    ):
        scene.add(name, [[a, 0, c], [a, 0, d], [b, 0, d], [b, 0, c]], wall)
    return scene


def work_plane(spacing: float = 0.5, height: float = SILL) -> tuple[np.ndarray, np.ndarray, tuple[int, int]]:
    """Return the points (m, 3) of the work plane, their upward normals (m, 3), and the grid's rows and columns."""
    x = np.arange(spacing, LENGTH, spacing)
    y = np.arange(spacing, DEPTH, spacing)
    points = np.array([[a, b, height] for b in y for a in x])
    return points, np.broadcast_to([0.0, 0.0, 1.0], points.shape), (len(y), len(x))


def daylight_factors() -> tuple[np.ndarray, np.ndarray]:
    """Return daylight factors and sky components on the grid, both in percent, (rows, columns) from the window in."""
    result = luz.prepare(room(), max_area=0.03).solve(luz.Daylight(sky=luz.CIESky(16, horizontal_illuminance=OUTDOORS)))
    points, normals, shape = work_plane()
    total, sky = result.at(points, normals), result.at(points, normals, initial=True)
    return 100 * total.reshape(shape) / OUTDOORS, 100 * sky.reshape(shape) / OUTDOORS


def statistics(factors: np.ndarray, threshold: float = 2.0) -> dict[str, float]:
    """Return minimum, mean, median, maximum, uniformity (minimum / mean) and the share from a threshold up [%]."""
    return {
        "minimum": float(factors.min()),
        "mean": float(factors.mean()),
        "median": float(np.median(factors)),
        "maximum": float(factors.max()),
        "uniformity": float(factors.min() / factors.mean()),
        f"share above {threshold:g} %": float(100 * np.mean(factors >= threshold)),
    }


def main() -> None:
    """Print the grid and its statistics."""
    factors, sky = daylight_factors()
    print("daylight factor [%], window at the top")
    for row in factors:
        print("".join(f"{value:>6.2f}" for value in row))
    print()
    for name, value in statistics(factors).items():
        print(f"{name:<20}{value:>8.2f}")
    print(f"{'from the sky itself':<20}{100 * sky.sum() / factors.sum():>8.1f} %")


if __name__ == "__main__":
    main()
