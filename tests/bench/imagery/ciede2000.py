"""Colour difference CIEDE2000 of sRGB colours.

Formula: G. Sharma, W. Wu, E. N. Dalal: The CIEDE2000 color-difference formula: implementation notes, supplementary test data, and
mathematical observations. Color Research and Application 30 (2005) 21-30; kL = kC = kH = 1. sRGB to CIELAB by IEC 61966-2-1, D65.
"""
import math

import numpy as np

WHITE = np.array([0.95047, 1.0, 1.08883])
TO_XYZ = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])


def lab(rgb):
    """sRGB (3,), 0..255 -> CIELAB (3,)."""
    c = np.asarray(rgb, float) / 255
    c = np.where(c <= .04045, c / 12.92, ((c + .055) / 1.055)**2.4)
    t = TO_XYZ @ c / WHITE
    f = np.where(t > 216 / 24389, np.cbrt(t), (24389 / 27 * t + 16) / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def difference(p, q):
    """CIEDE2000 of two CIELAB colours (3,)."""
    l1, a1, b1 = (float(v) for v in p)
    l2, a2, b2 = (float(v) for v in q)
    mean = (math.hypot(a1, b1) + math.hypot(a2, b2)) / 2
    g = .5 * (1 - math.sqrt(mean**7 / (mean**7 + 25**7)))
    a1, a2 = (1 + g) * a1, (1 + g) * a2
    c1, c2 = math.hypot(a1, b1), math.hypot(a2, b2)
    h1 = math.degrees(math.atan2(b1, a1)) % 360 if c1 else 0.0
    h2 = math.degrees(math.atan2(b2, a2)) % 360 if c2 else 0.0
    dl, dc = l2 - l1, c2 - c1
    turn = 0.0
    if c1 * c2:
        turn = h2 - h1
        turn += -360 if turn > 180 else 360 if turn < -180 else 0
    dh = 2 * math.sqrt(c1 * c2) * math.sin(math.radians(turn / 2))
    lm, cm = (l1 + l2) / 2, (c1 + c2) / 2
    if not c1 * c2:
        hm = h1 + h2
    elif abs(h1 - h2) <= 180:
        hm = (h1 + h2) / 2
    else:
        hm = (h1 + h2 + 360) / 2 if h1 + h2 < 360 else (h1 + h2 - 360) / 2
    cos = lambda d: math.cos(math.radians(d))
    t = 1 - .17 * cos(hm - 30) + .24 * cos(2 * hm) + .32 * cos(3 * hm + 6) - .20 * cos(4 * hm - 63)
    sl = 1 + .015 * (lm - 50)**2 / math.sqrt(20 + (lm - 50)**2)
    sc, sh = 1 + .045 * cm, 1 + .015 * cm * t
    rt = -2 * math.sqrt(cm**7 / (cm**7 + 25**7)) * math.sin(math.radians(60 * math.exp(-((hm - 275) / 25)**2)))
    return math.sqrt((dl / sl)**2 + (dc / sc)**2 + (dh / sh)**2 + rt * dc / sc * dh / sh)


def of_srgb(p, q):
    return difference(lab(p), lab(q))
