"""Blender extension LuzEspecular. Imports nothing until Blender asks, so that any tool may import this file."""


def register():
    """Enable the extension."""
    from . import luzespecular_addon

    luzespecular_addon.register()


def unregister():
    """Disable the extension."""
    from . import luzespecular_addon

    luzespecular_addon.unregister()
