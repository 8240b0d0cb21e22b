"""How finely to calculate."""

import bpy

from .kinds import EnumProperty, FloatProperty, IntProperty


class LuzAccuracySettings(bpy.types.PropertyGroup):
    """How finely to calculate."""

    fineness: EnumProperty(
        name="Fineness",
        description="How finely surfaces and sky are divided",
        items=(
            ("DRAFT", "Draft", "A first look: a quarter of the faces, a coarser globe"),
            ("NORMAL", "Normal", "Faces chosen for the scene, a globe of 60 bands"),
            ("FINE", "Fine", "Four times the faces, a globe of 90 bands"),
            ("EXPERT", "Expert", "The numbers given here"),
        ),
        default="NORMAL",
    )
    bands: IntProperty(
        name="Bands",
        description="Bands of the globe from zenith to nadir; 60 make 5,902 parcels",
        min=6,
        max=360,
        default=60,
    )
    max_area: FloatProperty(
        name="Largest Face (m²)",
        description="Faces are divided until none is larger; 0 lets the solver choose",
        min=0.0,
        default=0.0,
        precision=4,
    )


CLASSES = (LuzAccuracySettings,)
