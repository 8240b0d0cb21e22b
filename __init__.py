"""Blender extension LuzEspecular. Imports nothing until Blender asks, so that other tools may import this file freely."""


def register():
    """Enable the extension."""
    from . import luzespecular_addon

    luzespecular_addon.register()


def unregister():
    """Disable the extension."""
    from . import luzespecular_addon

    luzespecular_addon.unregister()
