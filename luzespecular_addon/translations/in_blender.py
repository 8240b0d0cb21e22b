"""What the solver says, in Blender's words: its remedies speak of vertices and options, users have menus."""

from __future__ import annotations

IN_BLENDER = {
    "if this is a room seen from inside, turn its normals (reverse the order of the vertices)": (
        "if this is a room seen from inside, turn its normals (Edit Mode: Mesh > Normals > Recalculate Inside)"
    ),
    "turn its normals (reverse the order of the vertices), or make it two-sided": (
        "turn its normals (Edit Mode: Mesh > Normals > Flip), or set its Lit Sides to Both"
    ),
    "turn its normals, make it two-sided, or give it a second surface behind": (
        "turn its normals (Edit Mode: Mesh > Normals > Flip), set its Lit Sides to Both, or give it a thickness "
        "(Solidify modifier)"
    ),
    "recalculate its normals": "recalculate its normals (Edit Mode: Mesh > Normals > Recalculate Outside)",
    "turn the normals of one of them": "turn the normals of one of them (Edit Mode: Mesh > Normals > Flip)",
    "merge their vertices or remove them": (
        "merge their vertices (Edit Mode: Mesh > Merge > By Distance) or remove them"
    ),
    "move their edges together, or merge their vertices": (
        "move their edges together, or join the objects and merge their vertices "
        "(Edit Mode: Mesh > Merge > By Distance)"
    ),
    "simplify its mesh: it takes much time and gives little light": (
        "simplify its mesh (Decimate modifier): it takes much time and gives little light"
    ),
    "lower their reflectances, turn them a little, or raise specular_cutoff": (
        "lower their reflectances, turn them a little, or raise Specular Cut-off (Accuracy: Expert)"
    ),
    "max_area {area} m² would cut the scene into some {count} faces, more than {most}; "
    "raise it to {enough} m² or more": (
        "A largest face of {area} m² would cut the scene into some {count} faces, more than {most}; "
        "raise it to {enough} m² or more"
    ),
    "The scene needs {needed} GB for {receivers} receivers, more than the {memory} GB "
    "of 'memory'; raise max_area, lower bands, or allow more memory": (
        "The scene needs {needed} GB for {receivers} receivers, more than the {memory} GB that it may take; "
        "raise Largest Face or lower Bands (Accuracy: Expert), or choose a coarser fineness"
    ),
}
"""Template of the solver's message -> template in Blender's words, with the same fields."""
