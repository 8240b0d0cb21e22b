"""How much daylight does a square mirror pipe bring down, and how does that fall with its length and the Sun's height?

A vertical pipe with walls of 95 % specular reflectance, open to the sky at its top; the answer is the mean illuminance
at its bottom over that on the open ground, for an overcast sky and for the Sun at several altitudes.

    python examples/mirror_light_pipe.py
"""

import math

import luzespecular as luz

OUTDOORS = 10_000.0  # lx
WIDTH = 0.6  # m
REFLECTANCE = 0.95
ALTITUDES = (20.0, 40.0, 60.0)
AZIMUTH = 30.0  # the pipe's sides look to the four points of the compass


def pipe(length: float, reflectance: float = REFLECTANCE, width: float = WIDTH) -> luz.Scene:
    """Return a square pipe whose black bottom lies at z = 0 and whose open top lies at z = ``length``."""
    w, h = width, length
    mirror = luz.Material(specular_reflectance=reflectance)
    scene = luz.Scene()
    scene.add("bottom", [[0, 0, 0], [w, 0, 0], [w, w, 0], [0, w, 0]], luz.Material())
    scene.add("west", [[0, 0, 0], [0, w, 0], [0, w, h], [0, 0, h]], mirror)
    scene.add("east", [[w, 0, h], [w, w, h], [w, w, 0], [w, 0, 0]], mirror)
    scene.add("south", [[0, 0, 0], [0, 0, h], [w, 0, h], [w, 0, 0]], mirror)
    scene.add("north", [[w, w, 0], [w, w, h], [0, w, h], [0, w, 0]], mirror)
    return scene


def overcast() -> luz.Daylight:
    """Return an overcast sky that gives ``OUTDOORS`` lux."""
    return luz.Daylight(sky=luz.CIESky(16, horizontal_illuminance=OUTDOORS))


def sunlight(altitude: float) -> luz.Daylight:
    """Return the Sun alone, giving ``OUTDOORS`` lux on the horizontal."""
    normal = OUTDOORS / math.sin(math.radians(altitude))
    return luz.Daylight(sun=luz.Sun(altitude=altitude, azimuth=AZIMUTH, normal_illuminance=normal))


def transmittances(ratio: float) -> list[float]:
    """Return the shares of the light outdoors that reach the bottom, for a pipe of a given length over width."""
    transfer = luz.prepare(pipe(ratio * WIDTH), max_area=0.005)
    lights = [overcast(), *map(sunlight, ALTITUDES)]
    return [transfer.solve(light).mean("bottom") / OUTDOORS for light in lights]


def main() -> None:
    """Print the table."""
    print("share of the outdoor illuminance that reaches the bottom")
    print(f"{'length / width':>15}{'overcast':>10}" + "".join(f"{f'Sun {a:.0f}°':>10}" for a in ALTITUDES))
    for ratio in (1, 2, 4):
        print(f"{ratio:>15}" + "".join(f"{share:>10.3f}" for share in transmittances(ratio)))


if __name__ == "__main__":
    main()
