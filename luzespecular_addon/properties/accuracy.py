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
            ("ERROR", "By Error", "As finely as it takes to keep below the error given here"),
            ("EXPERT", "Expert", "The numbers given here"),
        ),
        default="NORMAL",
    )
    error: FloatProperty(
        name="Error (%)",
        description="Relative error that about 95 of 100 faces shall keep below",
        min=0.1,
        max=20.0,
        default=2.0,
        precision=1,
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
    cycles: IntProperty(
        name="Cycles",
        description="Diffuse reflections to follow: exactly so many; -1 for as many as the tolerance asks",
        min=-1,
        max=1000,
        default=-1,
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description="Reflections stop when what is left to come is below this share of the mean illuminance",
        min=1e-8,
        max=0.1,
        default=1e-4,
        precision=6,
    )
    specular_cutoff: FloatProperty(
        name="Specular Cut-off",
        description="Chains of mirrors and panes are followed down to this product of reflectances",
        min=1e-6,
        max=1.0,
        default=1e-3,
        precision=6,
    )
    threads: IntProperty(
        name="Threads",
        description="Threads of the solver; 0 for as many as the machine has cores",
        min=0,
        max=1024,
        default=0,
    )


CLASSES = (LuzAccuracySettings,)
