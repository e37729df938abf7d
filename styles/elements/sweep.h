// Leads a moulding's section along walls: string courses, cornices, plinths, and along openings: surrounds.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "styles/elements/mesh_builder.h"
#include "styles/elements/profile.h"

namespace blockrand::elements {

/// On which side of the chain the wall's body is, walking along it and seen from above. Outlines of buildings run
/// counter-clockwise and have their house on the left.
enum class WallSide : std::uint8_t { left, right };

/// How a run ends that does not meet its own beginning.
enum class RunEnd : std::uint8_t {
  cut,  ///< a plane at right angles to the wall: party walls, corners of openings
  /// The moulding turns round the end and dies into the wall: it reaches beyond the end by its projection, beside an
  /// interruption only up to it.
  returned,
};

/// Brackets under a moulding (docs/sources.md, Finkenzeller 3.7.4), equally spaced, the row centred on each straight
/// wall.
struct ConsoleRow {
  double spacing = 0;       ///< m between middles; 0: no brackets
  double width = 0.16;      ///< m along the wall
  double height = 0.25;     ///< m, from their lower to their upper end
  double projection = 0.2;  ///< m out of the wall
  double top = 0.3;         ///< m above the lower edge of the moulding
};

struct SweepOptions {
  double base = 0;  ///< m, height of the moulding's lower edge: y of the mesh
  WallSide wall = WallSide::left;
  RunEnd ends = RunEnd::cut;
  /// How the chain's own first and last end differ from `ends`, seen along the chain with the wall on the left.
  std::optional<RunEnd> start_end, last_end;
  /// Degrees that the wall turns beyond the chain's first and last point, positive away from the moulding: there the
  /// run ends in the bisector's plane, for a moulding of the same section on the wall round the corner, instead of as
  /// above. 0: no such wall. A re-entrant corner for which the run is too short is not mitred.
  double start_turn = 0, last_turn = 0;
  Part part = Part::surround;
  /// Stretches without moulding, metres along the chain from its first point; they may overlap and come in any order.
  std::span<const std::pair<double, double>> interruptions;
  /// How far a mitre may reach beyond the moulding's own projection, as a multiple of it. Corners that are sharper are
  /// cut off square to their bisector. 3 mitres walls that meet at 39 degrees and more (own choice).
  double mitre_limit = 3;
  ConsoleRow consoles;
};

struct Sweep {
  /// Closed bodies. x and y of the chain become x and -z, up becomes y: the y-up frame of glTF and of rule files. A
  /// chain from (-w/2, 0) to (w/2, 0) with its wall on the left stands in the frame of ElementMesh.
  ElementMesh mesh;
  double length = 0;  ///< m of wall that got a moulding
  /// Corners where the mouldings of two walls end instead of meeting in a mitre, since a wall is too short there for
  /// it: indices into the chain. Their bodies overlap in re-entrant corners.
  std::vector<std::size_t> unmitred;
};

/// Leads a profile along a chain of walls. Mitres lie in the bisector plane of a corner; re-entrant corners take the
/// mouldings of both sides back. Chain points nearer than a millimetre to one another, or to the line between their
/// neighbours, make no corner.
///
/// \param profile  in metres, as scaled_to_height() gives it
/// \param chain    corners of the wall in plan, metres; at least two, three when closed
/// Error: a profile without a section, a chain without length. O(corners * points of the profile).
tl::expected<Sweep, std::string> sweep(const Profile& profile, std::span<const model::Point2> chain, bool closed,
                                       const SweepOptions& options = {});

/// A bracket's place: in the wall's line, looking out of the wall.
struct ConsolePlace {
  model::Point2 at, outwards;
};

/// Where brackets of a row stand on a chain: floor((L - width) / spacing) + 1 of them on each wall of length L, less
/// what re-entrant corners take and kApart at each end (docs/sources.md, Finkenzeller 3.7.4). For instances of one
/// "console" element.
std::vector<ConsolePlace> console_places(std::span<const model::Point2> chain, bool closed, WallSide wall,
                                         double spacing, double width, double projection);

/// One path of a sweep in any plane: the parts of sweep(), for surrounds and raking cornices.
struct PathSweep {
  Outline section;  ///< counter-clockwise in (x: to the right of the path, y: third direction)
  std::vector<model::Point2> path;
  bool closed = false;
  double mitre_limit = 3;
  Part part = Part::surround;
  /// Where the first and the last point's section goes per metre to the right, for ends that are not cut square:
  /// a vector whose part across the path is 1.
  std::optional<model::Point2> start, end;
  /// Maps (path x, path y, third direction) to the mesh; must keep orientation.
  std::function<model::Point3(double, double, double)> place;
};

/// Adds closed bodies; returns the indices of path points that could not be mitred.
/// \return nothing when the section cannot be cut into faces or the path has no length
std::optional<std::vector<std::size_t>> add_sweep(MeshBuilder& builder, const PathSweep& sweep);

/// Adds a bracket: a closed body standing out of the wall plane z = 0, its middle at x, its upper end at `top`.
void add_console(MeshBuilder& builder, double x, double top, double width, double height, double projection,
                 int detail);

}  // namespace blockrand::elements
