"""What does clear glass take from a room's daylight? The same room with an open and with a glazed window.

A room of 4 m x 5 m x 3 m with a window to the north, at 35° south: a pane of refractive index 1.52 that transmits 88 %
at normal incidence. Its transmittance falls with the angle of incidence, and what it mirrors is followed as well.

    python examples/glazed_window.py
"""

import numpy as np

import luzespecular as luz

INDEX = 1.52
NORMAL_TRANSMITTANCE = 0.88
WINDOW = [[3.2, 5, 1.0], [3.2, 5, 2.4], [0.8, 5, 2.4], [0.8, 5, 1.0]]  # looks inwards, to the south


def room(glazed: bool) -> luz.Scene:
    """Return the room; its north wall has a hole for the window, with a pane in it or without."""
    floor, wall, ceiling = (luz.Material(diffuse_reflectance=r) for r in (0.3, 0.5, 0.7))
    scene = luz.Scene()
    scene.add("floor", [[0, 0, 0], [4, 0, 0], [4, 5, 0], [0, 5, 0]], floor)
    scene.add("ceiling", [[0, 5, 3], [4, 5, 3], [4, 0, 3], [0, 0, 3]], ceiling)
    scene.add("wall_west", [[0, 0, 0], [0, 5, 0], [0, 5, 3], [0, 0, 3]], wall)
    scene.add("wall_east", [[4, 0, 3], [4, 5, 3], [4, 5, 0], [4, 0, 0]], wall)
    scene.add("wall_south", [[0, 0, 0], [0, 0, 3], [4, 0, 3], [4, 0, 0]], wall)
    x0, x1, z0, z1 = 0.8, 3.2, 1.0, 2.4
    for name, a, b, c, d in (
        ("sill", 0, 4, 0, z0),
        ("lintel", 0, 4, z1, 3),
        ("pier_west", 0, x0, z0, z1),
        ("pier_east", x1, 4, z0, z1),
    ):
        scene.add(name, [[b, 5, c], [b, 5, d], [a, 5, d], [a, 5, c]], wall)
    if glazed:
        glass = luz.Material(regular_transmittance=NORMAL_TRANSMITTANCE, refractive_index=INDEX)
        scene.add("window", WINDOW, glass)
    return scene


def morning() -> luz.Daylight:
    """Return a clear winter morning at 35° south: 10,000 lx from the sky, 70,000 lx from the Sun on its normal."""
    altitude, azimuth = luz.sun_position_solar(-35.0, 23.44, 10.0)
    sky = luz.CIESky(12, sun_altitude=altitude, sun_azimuth=azimuth, horizontal_illuminance=10_000)
    return luz.Daylight(sky=sky, sun=luz.Sun(altitude=altitude, azimuth=azimuth, normal_illuminance=70_000))


def overcast() -> luz.Daylight:
    """Return an overcast sky of 10,000 lx."""
    return luz.Daylight(sky=luz.CIESky(16, horizontal_illuminance=10_000))


def main() -> None:
    """Print mean illuminances without and with the pane."""
    transfers = [luz.prepare(room(glazed), max_area=0.03) for glazed in (False, True)]
    names = ("floor", "ceiling", "wall_west", "wall_east", "wall_south")
    for title, light in (("overcast sky", overcast()), ("clear sky and Sun, 10 h", morning())):
        results = [transfer.solve(light) for transfer in transfers]
        print(f"{title}\n{'mean lux':<12}{'open':>10}{'glazed':>10}{'ratio':>8}")
        for name in names:
            bare, glazed = (result.mean(name) for result in results)
            print(f"{name:<12}{bare:>10.0f}{glazed:>10.0f}{np.divide(glazed, bare):>8.3f}")
        print()


if __name__ == "__main__":
    main()
