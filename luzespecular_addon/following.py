"""What follows by itself when settings change: the Sun light of the scene, and results that are live."""

from __future__ import annotations

import bpy

from . import light, live, sun_light
from .notices import BadInput


def settings_changed(scene: bpy.types.Scene) -> None:
    """Bring all that depends on site, time and sky in step with a scene's settings."""
    point_sun_light(scene.luzespecular.site)
    live.request(scene, at_once=True)


def point_sun_light(site: bpy.types.PropertyGroup) -> None:
    """Turn the scene's Sun light to where the Sun stands, where the settings ask for it."""
    object_ = sun_light.chosen(site)
    if site.sun_link != "SET" or object_ is None:
        return
    try:
        place = light.sun_place(site)
    except BadInput:
        return  # the panel says what is wrong with the date; the light stays
    sun_light.point(object_.original, place.altitude, place.scene_azimuth)
