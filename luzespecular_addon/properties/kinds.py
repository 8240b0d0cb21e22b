"""Kinds of properties, in a translation context of their own.

Blender's own translation of a word goes first, and "Clear" is a verb to it.
"""

from functools import partial

from bpy import props

from ..translations import CONTEXT

BoolProperty = partial(props.BoolProperty, translation_context=CONTEXT)
EnumProperty = partial(props.EnumProperty, translation_context=CONTEXT)
FloatProperty = partial(props.FloatProperty, translation_context=CONTEXT)
IntProperty = partial(props.IntProperty, translation_context=CONTEXT)
ShareProperty = partial(FloatProperty, min=0.0, max=1.0, subtype="FACTOR")
StringProperty = partial(props.StringProperty, translation_context=CONTEXT)
