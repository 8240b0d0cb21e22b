"""A few cities to begin with: where they are and what their clocks show."""

from __future__ import annotations

from typing import NamedTuple


class Place(NamedTuple):
    """A city.

    Attributes
    ----------
    name : str
    latitude, longitude : float
        Degrees, north and east positive, to about a kilometre (GeoNames, CC BY 4.0).
    time_zone : float
        Hours ahead of UTC, without summer time (IANA time zone database, 2025).
    """

    name: str
    latitude: float
    longitude: float
    time_zone: float


PLACES = (
    Place("Belém", -1.456, -48.504, -3.0),
    Place("Belo Horizonte", -19.921, -43.938, -3.0),
    Place("Brasília", -15.780, -47.929, -3.0),
    Place("Curitiba", -25.428, -49.273, -3.0),
    Place("Florianópolis", -27.597, -48.549, -3.0),
    Place("Fortaleza", -3.717, -38.543, -3.0),
    Place("Manaus", -3.102, -60.025, -4.0),
    Place("Porto Alegre", -30.033, -51.230, -3.0),
    Place("Recife", -8.054, -34.881, -3.0),
    Place("Rio de Janeiro", -22.906, -43.182, -3.0),
    Place("Salvador", -12.971, -38.511, -3.0),
    Place("São Paulo", -23.548, -46.636, -3.0),
    Place("Berlin", 52.524, 13.411, 1.0),
    Place("Buenos Aires", -34.613, -58.377, -3.0),
    Place("Cairo", 30.063, 31.250, 2.0),
    Place("Johannesburg", -26.202, 28.044, 2.0),
    Place("Lisboa", 38.717, -9.133, 0.0),
    Place("London", 51.509, -0.126, 0.0),
    Place("México", 19.428, -99.128, -6.0),
    Place("New York", 40.714, -74.006, -5.0),
    Place("Oslo", 59.913, 10.746, 1.0),
    Place("Singapore", 1.290, 103.850, 8.0),
    Place("Sydney", -33.868, 151.207, 10.0),
    Place("Tokyo", 35.690, 139.692, 9.0),
)
"""Brazilian cities, then others, each by name."""
