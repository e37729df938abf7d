// What can be wrong with a solid, in the vocabulary of ISO 19107 with the numbers that val3dity made public.
#pragma once

#include <cstdint>
#include <iterator>
#include <string_view>

namespace blockrand::geometry {

/// X(enumerator, number, "name", "what it means"). The numbers are val3dity's (Ledoux 2013 and 2018,
/// https://val3dity.readthedocs.io): 1xx rings, 2xx polygons, 3xx shells, 4xx solids, 9xx what cannot be checked.
/// 304 was withdrawn there: both kinds of non-manifold are 303. 401 to 404 are about solids with several shells, which
/// no solid here has. Lower levels come first: a shell is checked when all of its polygons are sound.
#define BLOCKRAND_SOLID_DEFECTS(X)                                                                                    \
  X(none, 0, "none", "sound")                                                                                         \
  X(too_few_points, 101, "too few points", "a ring of fewer than three points")                                       \
  X(same_points, 102, "consecutive points the same", "a ring that has a point twice in a row")                        \
  X(ring_open, 103, "ring not closed",                                                                                \
    "a ring whose last point is not its first; only files that repeat it have such")                                  \
  X(ring_crosses, 104, "ring self-intersection", "a ring that crosses, touches or runs along itself, or has no area") \
  X(rings_meet, 201, "rings intersect", "two rings of a polygon that cross or touch")                                 \
  X(rings_equal, 202, "duplicated rings", "two rings of a polygon that are the same")                                 \
  X(not_planar, 203, "not planar", "a point farther than 1 cm from its polygon's plane")                              \
  X(folded, 204, "normals deviate", "a fold: two triangles of the polygon look more than 20 degrees apart")           \
  X(face_split, 205, "polygon interior disconnected", "rings that touch in several points and cut the polygon apart") \
  X(hole_outside, 206, "inner ring outside", "a hole that is not within the outer ring")                              \
  X(hole_in_hole, 207, "inner rings nested", "a hole within another hole")                                            \
  X(hole_turned, 208, "orientation of rings the same", "a hole that runs round the same way as the outer ring")       \
  X(too_few_faces, 301, "too few polygons", "a shell of fewer than four polygons")                                    \
  X(open_edge, 302, "shell not closed", "an edge with a polygon on one side only")                                    \
  X(non_manifold_edge, 303, "non-manifold edge", "an edge where more than two polygons meet")                         \
  X(non_manifold_vertex, 303, "non-manifold vertex", "polygons that meet in a point without sharing an edge there")   \
  X(not_connected, 305, "several components", "polygons that do not hang together over edges")                        \
  X(self_intersection, 306, "shell self-intersection",                                                                \
    "two polygons that cross, overlap, or touch where they share nothing")                                            \
  X(wrong_orientation, 307, "polygon wrong orientation", "two neighbouring polygons that look to different sides")    \
  X(inside_out, 405, "shell wrong orientation", "a shell that looks inwards")                                         \
  X(bad_index, 901, "bad index", "a ring that names a point that does not exist")                                     \
  X(empty, 902, "empty", "no polygons")

enum class SolidDefect : std::uint8_t {
#define X(id, number, name, meaning) id,
  BLOCKRAND_SOLID_DEFECTS(X)
#undef X
};

struct SolidDefectInfo {
  int number;  ///< val3dity's; 0 for none
  std::string_view name, meaning;
};
inline constexpr SolidDefectInfo kSolidDefects[] = {
#define X(id, number, name, meaning) {number, name, meaning},
    BLOCKRAND_SOLID_DEFECTS(X)
#undef X
};
inline constexpr int kSolidDefectCount = static_cast<int>(std::size(kSolidDefects));

constexpr std::string_view name(SolidDefect defect) { return kSolidDefects[static_cast<int>(defect)].name; }
/// val3dity's number of the defect; 0 for none.
constexpr int iso_code(SolidDefect defect) { return kSolidDefects[static_cast<int>(defect)].number; }

/// val3dity's number of parts of one building that overlap (BUILDINGPARTS_OVERLAP): no defect of a single solid.
inline constexpr int kPartsOverlapCode = 601;

}  // namespace blockrand::geometry
