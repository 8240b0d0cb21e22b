"""LuzEspecular: daylight illuminance, mirrors and glass included, by the Spherical Vector Model."""
