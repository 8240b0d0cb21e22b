"""Where and when: cities, the clock, the scene's Sun light."""

import datetime as dt
from typing import ClassVar

import bpy
from bpy.app.translations import pgettext_rpt as rpt_

from .. import following, places, sun_light


class LUZESPECULAR_OT_set_place(bpy.types.Operator):
    """Set latitude, longitude and time zone to those of a city."""

    bl_idname = "luzespecular.set_place"
    bl_label = "Set Place"
    bl_description = "Set latitude, longitude and time zone (without summer time) to those of a city"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    place: bpy.props.StringProperty(name="Place", description="Name of the city")

    def execute(self, context):
        """Set."""
        found = next((place for place in places.PLACES if place.name == self.place), None)
        if found is None:
            known = ", ".join(place.name for place in places.PLACES)
            text = rpt_("There is no place '{name}' in the list: choose one of {known}")
            self.report({"ERROR"}, text.format(name=self.place, known=known))
            return {"CANCELLED"}
        site = context.scene.luzespecular.site
        site.latitude, site.longitude, site.time_zone = found.latitude, found.longitude, found.time_zone
        return {"FINISHED"}


class LUZESPECULAR_OT_set_now(bpy.types.Operator):
    """Set date and hour to this machine's, as clock time."""

    bl_idname = "luzespecular.set_now"
    bl_label = "Now"
    bl_description = "Set date, hour and time zone to those of this machine's clock"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    def execute(self, context):
        """Set."""
        now, site = dt.datetime.now().astimezone(), context.scene.luzespecular.site
        site.year, site.month, site.day, site.time_kind = now.year, now.month, now.day, "CLOCK"
        site.time_zone = now.utcoffset().total_seconds() / 3600.0
        site.hour = now.hour + now.minute / 60.0
        return {"FINISHED"}


class LUZESPECULAR_OT_add_sun_light(bpy.types.Operator):
    """Choose the scene's Sun light, a new one where there is none, and turn it to where the Sun stands."""

    bl_idname = "luzespecular.add_sun_light"
    bl_label = "Use a Sun Light"
    bl_description = "Choose the scene's Sun light, a new one where there is none, and turn it to where the Sun stands"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    def execute(self, context):
        """Choose or make, and turn."""
        scene = context.scene
        site = scene.luzespecular.site
        light = sun_light.chosen(site) or next(filter(sun_light.is_sun, scene.objects), None)
        if light is None:
            light = bpy.data.objects.new(rpt_("Sun"), bpy.data.lights.new(rpt_("Sun"), "SUN"))
            light.data.angle = sun_light.ANGULAR_DIAMETER
            scene.collection.objects.link(light)
        site.sun_object, site.sun_link = light, "SET"
        following.settings_changed(scene)
        return {"FINISHED"}


CLASSES = (LUZESPECULAR_OT_set_place, LUZESPECULAR_OT_set_now, LUZESPECULAR_OT_add_sun_light)
