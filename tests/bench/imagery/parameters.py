"""Parameters of the synthetic orthophotos: two sets that share nothing but their meaning.

`tuning` is for looking while analysis is written; `judging` gives the figures. Colours are sRGB 0..255 of the material.
"""
import math

# Roof materials: name -> (texture kind, colours). Colours near references/styles.md 2.7 and what German and Austrian orthophotos show.
MATERIALS = {
    "red_tile": ("tile", [(172, 92, 68), (156, 78, 58), (186, 108, 76), (150, 84, 66), (196, 118, 90)]),
    "brown_tile": ("tile", [(112, 74, 58), (98, 66, 54), (124, 88, 70), (90, 62, 52)]),
    "dark_slate": ("tile", [(72, 76, 84), (84, 86, 92), (62, 64, 70)]),
    "grey_bitumen": ("bitumen", [(104, 104, 102), (122, 120, 116), (86, 86, 86), (138, 136, 130)]),
    "gravel": ("gravel", [(164, 156, 140), (150, 144, 132), (178, 172, 158)]),
    "green_copper": ("sheet", [(128, 166, 146), (112, 150, 132), (146, 178, 160)]),
    "light_sheet": ("sheet", [(184, 188, 190), (168, 174, 178), (200, 200, 196)]),
}

SETS = {
    "tuning": dict(
        sun_azimuth=(140, 170), sun_elevation=(40, 50),          # degrees, from north clockwise / above the horizon
        flight_height=1400, frame=420, nadir_offset=(120, 260),  # m: leans of about 0.05 to 0.3
        pitched=dict(red_tile=.55, brown_tile=.2, dark_slate=.12, green_copper=.03, light_sheet=.1),
        flat=dict(grey_bitumen=.5, gravel=.3, light_sheet=.15, green_copper=.05),
        eaves=(0.15, 0.5), parapet=0.6,                          # m of overhang; share of flat roofs with a coping
        garden_trees=16, wall_trees=4, street_trees=0.25, tree_tint=(70, 96, 52),  # per ha of open ground; per ha; share of 14 m places
        cars=0.45, clutter=1.0, fences=12, sheds=3, unkempt=0.35,   # share of parking places; factor; per ha; per ha; share of soil
        sun=(3.0, 2.85, 2.6), sky=(0.66, 0.76, 0.92), exposure=0.33,
        haze=(0.012, 0.014, 0.018), cast=(1.0, 1.0, 0.98), saturation=0.92, contrast=1.0,
        vignetting=0.10, step=0.05, blur=0.65, sharpen=0.0, noise=0.006, jpeg=92),
    "judging": dict(
        sun_azimuth=(195, 235), sun_elevation=(31, 42),
        flight_height=1900, frame=520, nadir_offset=(180, 400),
        pitched=dict(red_tile=.4, brown_tile=.25, dark_slate=.18, green_copper=.05, light_sheet=.12),
        flat=dict(grey_bitumen=.42, gravel=.33, light_sheet=.18, green_copper=.07),
        eaves=(0.1, 0.7), parapet=0.5,
        garden_trees=24, wall_trees=7, street_trees=0.4, tree_tint=(82, 92, 48),
        cars=0.6, clutter=1.3, fences=16, sheds=5, unkempt=0.5,
        sun=(2.9, 2.62, 2.2), sky=(0.56, 0.66, 0.85), exposure=0.33,
        haze=(0.028, 0.033, 0.040), cast=(0.96, 1.0, 1.03), saturation=0.88, contrast=1.08,
        vignetting=0.16, step=0.09, blur=0.8, sharpen=0.35, noise=0.010, jpeg=85),
}


def sun_of(p, rng):
    """(azimuth, elevation) in degrees of one picture of a set."""
    return float(rng.uniform(*p["sun_azimuth"])), float(rng.uniform(*p["sun_elevation"]))


def sun_step(azimuth, elevation):
    """(2,) metres east and north towards the sun per metre of height."""
    c = 1 / math.tan(math.radians(elevation))
    return math.sin(math.radians(azimuth)) * c, math.cos(math.radians(azimuth)) * c
