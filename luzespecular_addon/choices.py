"""What there is to choose from, where the list is long or read elsewhere: (key, name, description) each."""

from __future__ import annotations

SKY_ITEMS = (
    ("CLEAR", "Clear", "Clear sky with Sun (CIE type 12)"),
    ("INTERMEDIATE", "Intermediate", "Partly cloudy sky with a dim Sun (CIE type 10)"),
    ("OVERCAST", "Overcast", "Overcast sky without Sun (traditional, type 16)"),
    ("CIE", "CIE type", "One of the CIE standard general skies, by its number"),
    ("NONE", "None", "No sky: the Sun and luminous surfaces only"),
)

CIE_ITEMS = (
    ("1", "1 Overcast, steep gradation", "CIE standard overcast sky: steep gradation, the same in all azimuths"),
    ("2", "2 Overcast, steep, brighter to the Sun", "Steep gradation, slight brightening towards the Sun"),
    ("3", "3 Overcast, moderate gradation", "Moderate gradation, the same in all azimuths"),
    ("4", "4 Overcast, moderate, brighter to the Sun", "Moderate gradation, slight brightening towards the Sun"),
    ("5", "5 Uniform", "The same luminance everywhere"),
    ("6", "6 Partly cloudy, brighter to the Sun", "No gradation, slight brightening towards the Sun"),
    ("7", "7 Partly cloudy, brighter around the Sun", "No gradation, brighter circumsolar region"),
    ("8", "8 Partly cloudy, solar corona", "No gradation, distinct solar corona"),
    ("9", "9 Partly cloudy, Sun obscured", "With the obscured Sun"),
    ("10", "10 Partly cloudy, graded, brighter around the Sun", "With a brighter circumsolar region"),
    ("11", "11 White-blue, solar corona", "White-blue sky with distinct solar corona"),
    ("12", "12 Clear, clean air", "CIE standard clear sky, low luminance turbidity"),
    ("13", "13 Clear, polluted air", "CIE standard clear sky, polluted atmosphere"),
    ("14", "14 Turbid, broad corona", "Cloudless turbid sky with broad solar corona"),
    ("15", "15 White-blue turbid, broad corona", "White-blue turbid sky with broad solar corona"),
    ("16", "16 Traditional overcast", "Moon and Spencer: the horizon is a third as bright as the zenith"),
)

QUANTITY_ITEMS = (
    ("illuminance", "Total", "All light, interreflection included"),
    ("initial", "Initial", "Before any diffuse reflection: sky, Sun and luminous surfaces, direct and by mirrors"),
    ("sky_direct", "Sky, direct", "Light straight from the sky and the ground"),
    ("sky_specular", "Sky, by mirrors", "Sky light through mirrors and panes"),
    ("sun_direct", "Sun, direct", "Light straight from the Sun"),
    ("sun_specular", "Sun, by mirrors", "Sunlight through mirrors and panes"),
    ("emitted", "Luminous surfaces", "Light from surfaces that emit by themselves, their mirror images included"),
    ("interreflected", "Interreflected", "Light that has met a diffuse surface"),
    ("error", "Error", "Estimate of what 95 of 100 faces' errors are below; of fronts only"),
)

UNIT_ITEMS = (
    ("LUX", "Lux (lx)", "Illuminance"),
    ("FACTOR", "DF (%)", "Daylight factor: share of what the whole sky, without Sun, gives an open horizontal plane"),
)

CORNER_ITEMS = (
    ("BOTTOM_LEFT", "Bottom Left", "In the lower left corner of the picture"),
    ("BOTTOM_RIGHT", "Bottom Right", "In the lower right corner of the picture"),
    ("TOP_LEFT", "Top Left", "In the upper left corner of the picture"),
    ("TOP_RIGHT", "Top Right", "In the upper right corner of the picture"),
)

SCALE_ITEMS = (
    ("VIRIDIS", "Viridis", "Even steps of lightness, safe for the colour-blind"),
    ("CIVIDIS", "Cividis", "Blue to yellow, made for the colour-blind"),
    ("INFERNO", "Inferno", "Black through red to pale yellow, even steps of lightness"),
    ("SPECTRUM", "Spectrum", "Blue through green to red, as lighting programs made common"),
    ("GREY", "Grey", "Dark to light grey"),
)
