"""The light-shelf room of Claro & Pereira: geometry, materials and light of its variants and hours, as plain data.

A room of 3 m x 3 m x 3 m whose north face is open from z = 1.0 m to z = 2.5 m over its full width, with a light shelf
0.75 m deep at half the height of the opening: two sheets 5 cm apart, without edge faces. Every vertex list follows
the right-hand rule, its normal pointing into the room (the shelf's upper sheet looks up, its lower sheet down).

Source: A. Claro, F. O. R. Pereira, "Integração da especularidade ao método da radiosidade em iluminação", LabCon/UFSC;
its area of "0,05 m²" per triangle is a slip: squares of 7 cm have 0.0049 m², and 54 m² give some 10,800 triangles.
"""

from __future__ import annotations

from dataclasses import dataclass

SIZE = 3.0
SILL_HEIGHT, HEAD_HEIGHT = 1.0, 2.5
SHELF_DEPTH, SHELF_BOTTOM, SHELF_TOP = 0.75, 1.725, 1.775

SURFACES: dict[str, list[tuple[float, float, float]]] = {
    "floor": [(0, 0, 0), (3, 0, 0), (3, 3, 0), (0, 3, 0)],
    "ceiling": [(0, 3, 3), (3, 3, 3), (3, 0, 3), (0, 0, 3)],
    "wall_west": [(0, 0, 0), (0, 3, 0), (0, 3, 3), (0, 0, 3)],
    "wall_east": [(3, 0, 3), (3, 3, 3), (3, 3, 0), (3, 0, 0)],
    "wall_south": [(0, 0, 0), (0, 0, 3), (3, 0, 3), (3, 0, 0)],
    "sill": [(3, 3, 0), (3, 3, 1.0), (0, 3, 1.0), (0, 3, 0)],
    "lintel": [(3, 3, 2.5), (3, 3, 3), (0, 3, 3), (0, 3, 2.5)],
    "shelf_bottom": [(0, 3, 1.725), (3, 3, 1.725), (3, 2.25, 1.725), (0, 2.25, 1.725)],
    "shelf_top": [(0, 2.25, 1.775), (3, 2.25, 1.775), (3, 3, 1.775), (0, 3, 1.775)],
}

REFLECTANCE = {
    "floor": 0.40,
    "ceiling": 0.60,
    "wall_west": 0.50,
    "wall_east": 0.50,
    "wall_south": 0.50,
    "sill": 0.50,
    "lintel": 0.50,
    "shelf_bottom": 0.80,
    "shelf_top": 0.90,
}


@dataclass(frozen=True)
class Variant:
    """One set of materials: which surfaces reflect like mirrors (their whole reflectance), the others being diffuse."""

    key: str
    title: str
    specular: frozenset[str]


VARIANTS = {
    "D": Variant("D", "all diffuse", frozenset()),
    "S1": Variant("S1", "mirror shelf", frozenset({"shelf_top"})),
    "S2": Variant("S2", "mirror shelf and mirror ceiling", frozenset({"shelf_top", "ceiling"})),
}

LATITUDE = -27.0
LONGITUDE = -48.5  # Florianópolis; without effect as long as the hours are solar
DAY, MONTH = 22, 6
DECLINATION = 23.44
HOURS = (9.0, 10.0, 12.0)

SKY_ILLUMINANCE = 10_000.0  # lx on the open horizontal, sky alone
SUN_ILLUMINANCE = 80_000.0  # lx on the plane that faces the Sun
UNIFORM_LUMINANCE = 1_000.0  # cd/m²
FACE_AREA = 0.005  # m², the paper's fracture

SKIES = ("clear", "overcast", "uniform", None)


def scene(variant: str = "S1"):
    """Return the ``luzespecular.Scene`` of a variant: "D", "S1" or "S2"."""
    import luzespecular as luz  # here, so that the plain data also serves where only Blender is installed

    specular = VARIANTS[variant].specular
    room = luz.Scene()
    for name, vertices in SURFACES.items():
        kind = "specular_reflectance" if name in specular else "diffuse_reflectance"
        room.add(name, vertices, luz.Material(**{kind: REFLECTANCE[name]}))
    return room


def sun_position(hour: float) -> tuple[float, float]:
    """Return the Sun's altitude and azimuth in degrees at a solar hour of the room's day."""
    import luzespecular as luz

    altitude, azimuth = luz.sun_position_solar(LATITUDE, DECLINATION, hour)
    return float(altitude), float(azimuth)


def daylight(hour: float = 12.0, sky: str | None = "clear", sun: bool = True):
    """Return the ``luzespecular.Daylight`` of a solar hour on 22 June at 27° south.

    Parameters
    ----------
    hour : float
        Solar time [h].
    sky : {"clear", "overcast", "uniform", None}
        CIE type 12 or CIE traditional overcast, both scaled to 10,000 lx on the open horizontal; a uniform sky of
        1,000 cd/m²; or no sky at all.
    sun : bool
        Whether the Sun shines, with 80,000 lx on the plane that faces it.
    """
    import luzespecular as luz

    altitude, azimuth = sun_position(hour)
    if sky == "clear":
        dome = luz.CIESky(12, sun_altitude=altitude, sun_azimuth=azimuth, horizontal_illuminance=SKY_ILLUMINANCE)
    elif sky == "overcast":
        dome = luz.CIESky(16, horizontal_illuminance=SKY_ILLUMINANCE)
    elif sky == "uniform":
        dome = luz.UniformSky(UNIFORM_LUMINANCE)
    elif sky is None:
        dome = None
    else:
        raise ValueError(f"unknown sky {sky!r}: choose one of {SKIES}")
    beam = luz.Sun(altitude=altitude, azimuth=azimuth, normal_illuminance=SUN_ILLUMINANCE) if sun else None
    return luz.Daylight(sky=dome, sun=beam)


def grid(vertices: list[tuple[float, float, float]], step: float = 0.1):
    """Return a rectangle as squares of at most ``step``: its vertices and its faces, oriented as the rectangle.

    Cut in two, squares of 0.1 m are the paper's triangles of 0.005 m².
    """
    first, second, _, last = vertices

    def cells(a, b):
        length = sum((q - p) ** 2 for p, q in zip(a, b, strict=True)) ** 0.5
        return max(1, int(-(-(length - 1e-9) // step)))

    across, along = cells(first, second), cells(first, last)
    points = [
        tuple(p + (q - p) * i / across + (r - p) * j / along for p, q, r in zip(first, second, last, strict=True))
        for j in range(along + 1)
        for i in range(across + 1)
    ]
    corners = [j * (across + 1) + i for j in range(along) for i in range(across)]
    return points, [(a, a + 1, a + across + 2, a + across + 1) for a in corners]
