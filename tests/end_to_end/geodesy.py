"""Positions on the Earth by another way than the program's: PROJ by ctypes where it is installed, and textbook formulas.

The formulas share no code with the program: UTM by Krüger's series in complex numbers, ECEF by Bowring's formula.
"""
import cmath
import ctypes
import ctypes.util
import math

WGS84_A, WGS84_F = 6378137.0, 1 / 298.257223563
GRS80_F = 1 / 298.257222101


def utm(lon, lat, zone, flattening=GRS80_F):
    """Easting, northing (north) by Krüger's series in the third flattening to n^4 (Krüger 1912, p. 21), < 1e-5 m.

    Written with complex numbers: xi' + i eta' as one, so that a slip in a sign cannot be shared with real-valued code.
    """
    n = flattening / (2 - flattening)
    e = math.sqrt(flattening * (2 - flattening))
    radius = WGS84_A / (1 + n) * (1 + n ** 2 / 4 + n ** 4 / 64)
    series = (n / 2 - 2 * n ** 2 / 3 + 5 * n ** 3 / 16 + 41 * n ** 4 / 180,
              13 * n ** 2 / 48 - 3 * n ** 3 / 5 + 557 * n ** 4 / 1440,
              61 * n ** 3 / 240 - 103 * n ** 4 / 140,
              49561 * n ** 4 / 161280)
    phi, along = math.radians(lat), math.radians(lon - (6 * zone - 183))
    s = math.sin(phi)
    conformal = math.sinh(math.atanh(s) - e * math.atanh(e * s))
    z = complex(math.atan2(conformal, math.cos(along)), math.asinh(math.sin(along) / math.hypot(conformal, math.cos(along))))
    z += sum(a * cmath.sin(2 * (k + 1) * z) for k, a in enumerate(series))
    return 500000 + 0.9996 * radius * z.imag, 0.9996 * radius * z.real


def geodetic(x, y, z):
    """Longitude, latitude (degrees) and ellipsoidal height of an ECEF point (Bowring 1976, one step: < 1e-9 m near the
    surface)."""
    e2 = WGS84_F * (2 - WGS84_F)
    b = WGS84_A * (1 - WGS84_F)
    p = math.hypot(x, y)
    u = math.atan2(z * WGS84_A, p * b)
    phi = math.atan2(z + e2 / (1 - e2) * b * math.sin(u) ** 3, p - e2 * WGS84_A * math.cos(u) ** 3)
    nu = WGS84_A / math.sqrt(1 - e2 * math.sin(phi) ** 2)
    height = p * math.cos(phi) + z * math.sin(phi) - WGS84_A ** 2 / nu
    return math.degrees(math.atan2(y, x)), math.degrees(phi), height


def metres_between(a, b):
    """Horizontal distance of two near (lon, lat) in metres."""
    e2, phi = WGS84_F * (2 - WGS84_F), math.radians((a[1] + b[1]) / 2)
    w = 1 - e2 * math.sin(phi) ** 2
    north = math.radians(a[1] - b[1]) * WGS84_A * (1 - e2) / w ** 1.5
    east = math.radians(a[0] - b[0]) * WGS84_A * math.cos(phi) / math.sqrt(w)
    return math.hypot(north, east)


class Coordinates(ctypes.Structure):
    _fields_ = [(name, ctypes.c_double) for name in 'xyzt']


class Proj:
    """libproj itself, without any wrapper. \\raises OSError where it is not installed."""

    def __init__(self, source, target):
        name = ctypes.util.find_library('proj')
        if not name:
            raise OSError('libproj is not installed')
        self.lib = ctypes.CDLL(name)
        self.lib.proj_create_crs_to_crs.restype = ctypes.c_void_p
        self.lib.proj_create_crs_to_crs.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_char_p, ctypes.c_void_p]
        self.lib.proj_normalize_for_visualization.restype = ctypes.c_void_p
        self.lib.proj_normalize_for_visualization.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
        self.lib.proj_trans.restype = Coordinates
        self.lib.proj_trans.argtypes = [ctypes.c_void_p, ctypes.c_int, Coordinates]
        made = self.lib.proj_create_crs_to_crs(None, source.encode(), target.encode(), None)
        if not made:
            raise OSError(f'PROJ has no way from {source} to {target}')
        self.transformation = self.lib.proj_normalize_for_visualization(None, made)

    def __call__(self, x, y, z=0.0):
        out = self.lib.proj_trans(self.transformation, 1, Coordinates(x, y, z, math.inf))
        return out.x, out.y, out.z
