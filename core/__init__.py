"""LuzEspecular: daylight illuminance, mirrors and glass included, by the Spherical Vector Model."""

from . import solve as _solve  # noqa: F401 - before the function of this name, which a later import would hide
from .annual import Annual
from .availability import availability, default_daylight
from .balance import Balance
from .daylight import Daylight
from .errors import Cancelled, LuzEspecularError, SceneError, TransferFileError
from .flaws import Finding
from .globe import Globe
from .inspection import check
from .materials import Material
from .preparation import load, prepare
from .result import Result
from .scene import Scene
from .sky import CIESky, MeasuredSky, PerezSky, UniformSky
from .sun import (
    Sun,
    declination,
    equation_of_time,
    solar_time,
    sun_position,
    sun_position_solar,
    sunrise_sunset,
)
from .transfer import Transfer

__version__ = "0.1.0"


def solve(scene: Scene, light: Daylight, **prepare_options) -> Result:
    """Prepare a scene and solve it for one light; options are those of `prepare`."""
    return prepare(scene, **prepare_options).solve(light)


__all__ = [
    "Annual",
    "Balance",
    "CIESky",
    "Cancelled",
    "Daylight",
    "Finding",
    "Globe",
    "LuzEspecularError",
    "Material",
    "MeasuredSky",
    "PerezSky",
    "Result",
    "Scene",
    "SceneError",
    "Sun",
    "Transfer",
    "TransferFileError",
    "UniformSky",
    "__version__",
    "availability",
    "check",
    "declination",
    "default_daylight",
    "equation_of_time",
    "load",
    "prepare",
    "solar_time",
    "solve",
    "sun_position",
    "sun_position_solar",
    "sunrise_sunset",
]
