"""The Sun light of the Blender scene: its direction read, or set to where the Sun stands."""

from __future__ import annotations

import math

import bpy
from mathutils import Matrix, Vector

ANGULAR_DIAMETER = math.radians(0.533)
"""Of the Sun as seen from the Earth [rad]."""


def chosen(site: bpy.types.PropertyGroup) -> bpy.types.Object | None:
    """Return the Sun light that the settings name; None where there is none or it is a Sun light no more."""
    object_ = site.sun_object
    return object_ if object_ is not None and is_sun(object_) else None


def is_sun(object_: bpy.types.Object) -> bool:
    """Whether an object is a Sun light."""
    return object_.type == "LIGHT" and object_.data.type == "SUN"


def read(object_: bpy.types.Object) -> tuple[float, float]:
    """Return altitude and azimuth of where a Sun light shines from [degrees], azimuth clockwise from the +Y axis."""
    x, y, z = object_.matrix_world.to_3x3().normalized() @ Vector((0.0, 0.0, 1.0))
    return math.degrees(math.atan2(z, math.hypot(x, y))), math.degrees(math.atan2(x, y)) % 360.0


def point(object_: bpy.types.Object, altitude: float, azimuth: float) -> None:
    """Turn a Sun light to shine from an altitude and an azimuth [degrees, clockwise from the +Y axis]."""
    high, around = math.radians(altitude), math.radians(azimuth)
    towards = Vector((math.cos(high) * math.sin(around), math.cos(high) * math.cos(around), math.sin(high)))
    location, _, scale = object_.matrix_world.decompose()
    object_.matrix_world = Matrix.LocRotScale(location, towards.to_track_quat("Z", "Y"), scale)
