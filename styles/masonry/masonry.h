// Stones of a wall: laid out around its openings and corners, as flat polygons with roles. After Finkenzeller (Modellierung komplexer
// Gebaeudefassaden in der Computergraphik, 2008), section 5.3: the layout is made for the wall at hand, openings and all. Beyond it,
// bonds go on round corners and stones become relief (relief.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::masonry {

/// How stones lie. The first four are brick bonds, `ashlar` has courses of one height and stones of free length, `rubble` and
/// `cyclopean` have no courses: irregular cells, flat ones or large ones.
// X(identifier, name)
#define BLOCKRAND_MASONRY_BONDS(X) \
  X(stretcher, "stretcher")        \
  X(header, "header")              \
  X(english, "english")            \
  X(flemish, "flemish")            \
  X(ashlar, "ashlar") X(rubble, "rubble") X(cyclopean, "cyclopean")
enum class Bond : std::uint8_t {
#define X(id, text) id,
  BLOCKRAND_MASONRY_BONDS(X)
#undef X
};
inline constexpr std::string_view kBondNames[] = {
#define X(id, text) text,
    BLOCKRAND_MASONRY_BONDS(X)
#undef X
};
constexpr bool is_brick(Bond bond) { return bond <= Bond::flemish; }
constexpr bool has_courses(Bond bond) { return bond <= Bond::ashlar; }

/// A size of bricks with its usual joints; m.
struct BrickFormat {
  std::string_view name;
  double length, width, height, perpend, bed;
};
/// DIN 105 and DIN 4172 (octametric: 12 courses of Normalformat or 16 of Duennformat a metre), the German Reichsformat of 1872 (13
/// courses a metre), BS 3921 (75 mm a course), and a medieval Klosterformat, which varied by place by some centimetres.
inline constexpr BrickFormat kBrickFormats[] = {
    {"normal", 0.240, 0.115, 0.071, 0.010, 0.01233}, {"thin", 0.240, 0.115, 0.052, 0.010, 0.0105},
    {"reich", 0.250, 0.120, 0.065, 0.010, 0.012},    {"british", 0.215, 0.1025, 0.065, 0.010, 0.010},
    {"kloster", 0.285, 0.135, 0.085, 0.015, 0.015},
};

/// How a wall is to be laid; m. Lengths are those of stones, joints lie between them.
struct Masonry {
  Bond bond = Bond::stretcher;
  double length = 0.24;   ///< of bricks; of ashlar and cells the mean
  double width = 0.115;   ///< of bricks: what a header shows; of ashlar: what a quoin shows on its short side
  double height = 0.071;  ///< of a course less its bed joint; of cells the mean
  double perpend = 0.01;  ///< upright joints, all joints of cells
  double bed = 0.012;     ///< level joints
  double relief = 0.008;  ///< of stones before the mortar
  double course() const { return height + bed; }
};
/// Whether sizes make sense: positive, joints narrower than stones.
bool can_be_laid(const Masonry& masonry);
/// Usual sizes: Normalformat; ashlar of 0.62 x 0.30, rubble of 0.32 x 0.17, cyclopean stones of 0.60 m.
Masonry usual_masonry(Bond bond);

// X(identifier, name)
#define BLOCKRAND_STONE_ROLES(X) \
  X(stretcher, "stretcher")      \
  X(header, "header")            \
  X(closer, "closer")            \
  X(quoin, "quoin")              \
  X(voussoir, "voussoir")        \
  X(keystone, "keystone") X(lintel, "lintel") X(sill, "sill") X(field, "field")
enum class StoneRole : std::uint8_t {
#define X(id, text) id,
  BLOCKRAND_STONE_ROLES(X)
#undef X
};
inline constexpr std::string_view kStoneRoleNames[] = {
#define X(id, text) text,
    BLOCKRAND_STONE_ROLES(X)
#undef X
};
inline constexpr int kStoneRoleCount = sizeof(kStoneRoleNames) / sizeof(kStoneRoleNames[0]);

/// Coordinates of a wall: u to the viewer's right, v up; m.
struct WallToLay {
  std::vector<model::Point2> outline;                ///< counter-clockwise
  std::vector<std::vector<model::Point2>> openings;  ///< counter-clockwise, straight pieces: heads are read from them
  std::vector<std::vector<model::Point2>>
      covered;              ///< what other bodies cover: no stone is laid that lies in one as a whole
  double from = 0, to = 0;  ///< the run along the wall that is laid
  double ground = 0;        ///< v of the first course's lower edge; the same level on all walls of a house
  bool corner_left = false,
       corner_right = false;  ///< the run ends at a corner that stands out, and the next wall is laid, too
  std::uint64_t seed = 0;
};

struct Stone {
  std::vector<model::Point2> outline;  ///< counter-clockwise, simple; not always convex: stones are cut at openings
  StoneRole role = StoneRole::field;
  std::int32_t course = -1;                ///< from the ground; -1: lies in none
  std::uint8_t shade = 0;                  ///< 0, 1, 2
  bool at_left = false, at_right = false;  ///< goes round the corner there
};

struct LaidWall {
  std::vector<Stone> stones;  ///< courses upwards, from left to right; dressings of openings first
  std::size_t forced = 0;     ///< stones narrower than a closer: the wall has no more room there
  std::size_t dropped = 0;    ///< pieces too small for a stone, left to the mortar
  std::size_t undressed = 0;  ///< openings whose lintel or arch has no room
};

/// Lays a wall. Stones do not overlap, lie within the outline and outside the openings, and go by the seed alone.
///
/// Bricks: a run is divided into quarter bricks, as many as make a whole bond, so that bricks of a run are up to
/// (a quarter brick / its length) longer or shorter than their format and none is a sliver. At its right end courses of even number end
/// long and those of odd number short, at its left end the other way: so walls agree round every corner of a house. At openings bricks
/// are cut; no piece is narrower than a quarter.
/// \return none where can_be_laid() says so
std::optional<LaidWall> lay(const WallToLay& wall, const Masonry& masonry);

}  // namespace blockrand::masonry
