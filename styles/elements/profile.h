// The profile language of mouldings: a little drawing program for the section of a cornice
// (docs/sources.md, Finkenzeller 3.7.1).
//
//   Modifications {
//     line, rel, 90, 0.3;       turn from upright by 90 degrees towards the street, draw 0.3
//     arc, rel, 0, -90, 4;      from there a quarter circle of radius 4 that bends upwards
//     line, abs, -84, 22;       84 degrees from upright towards the wall, whatever came before
//   }
//
// A `#` starts a comment that ends with its line.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "styles/elements/flat_shapes.h"

namespace blockrand::elements {

/// A command of a profile program.
struct ProfileCommand {
  enum class Kind : std::uint8_t { line, arc } kind = Kind::line;
  bool relative = true;  ///< to the heading before; else to upright
  double angle = 0;      ///< degrees, turns towards the outside of the wall
  double sweep = 0;      ///< degrees, of arcs; positive turns towards the outside
  double length = 0;     ///< of lines; radius of arcs. Units of the program, until it is scaled
  /// Start, middle and end textures, as indices into the pool; negative: none on that part.
  std::optional<std::array<int, 3>> textures;
};

struct ProfileProgram {
  std::vector<ProfileCommand> commands;
};

/// Where and what is wrong in a program, line and column from 1.
struct ProfileError {
  int line = 1, column = 1;
  std::string message;
  std::string text() const;  ///< "line 3, column 7: an arc wants a radius"
};

/// More commands than any moulding has: bad input ends here.
inline constexpr std::size_t kMostProfileCommands = 1000;

tl::expected<ProfileProgram, ProfileError> parse_profile(std::string_view text);

/// The section of a moulding: an open polyline in (x: out of the wall, y: up), as it is walked from below.
struct Profile {
  std::vector<model::Point2> points;
  double heading = 0;  ///< degrees from upright towards the outside, at the end
  double height() const { return points.empty() ? 0 : bounds_of(points).height(); }
  double projection() const { return points.empty() ? 0 : bounds_of(points).most.x; }
};

/// Walks the program: starts at the wall's foot (0, 0) heading upright.
/// \param arc_steps  straight pieces of a quarter circle, at least 1; smaller arcs get fewer
Profile trace(const ProfileProgram& program, int arc_steps = 4);

/// The profile scaled evenly so that it is `height` metres high, standing on y = 0.
/// \param most_projection  m; a profile that would come out farther is squeezed towards the wall
Profile scaled_to_height(const Profile& profile, double height, double most_projection);

/// The three or four straight pieces that stand for a profile from afar: out to where it is widest, up, and back.
Profile silhouette(const Profile& profile);

/// m. What is finer than this in a section is left out: members of mouldings are centimetres, and solids on the 1/1024
/// m grid need walls 2/1024 m apart.
inline constexpr double kFinestMember = 0.003;

/// A projection near `wanted`, at most 3 cm less, at which the front of something that stands before the profile
/// between two heights lies kApart off every upright face of it: nothing coplanar.
double clear_of(const Profile& profile, double wanted, double from, double to);

/// A closed section for sweeps, counter-clockwise in (out of the wall, up): what stands out of the wall, and kApart of
/// its foot inside the wall. Error: nothing stands out, or the line crosses itself.
tl::expected<Outline, std::string> section_of(const Profile& profile);

}  // namespace blockrand::elements
