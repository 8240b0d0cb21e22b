"""The skies: one place to import them from.

A sky gives luminance by direction and its exact horizontal illuminance; it knows neither surfaces nor the Sun's beam.
"""

from .sky_cie import CIE_SKY_NAMES, SUNLESS_SKIES, CIESky, UniformSky
from .sky_measured import MeasuredSky
from .sky_model import Sky
from .sky_perez import PerezSky

__all__ = ["CIE_SKY_NAMES", "SUNLESS_SKIES", "CIESky", "MeasuredSky", "PerezSky", "Sky", "UniformSky"]
