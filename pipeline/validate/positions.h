// Places of OpenStreetMap nodes, sampled for the check of the georeference.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "pipeline/georef/proj_transform.h"
#include "pipeline/model/point.h"
#include "pipeline/validate/checked_json.h"

namespace blockrand::validate {

/// A corner of an outline as OpenStreetMap has it.
struct SampledCorner {
  model::Location at;
  std::uint64_t rank = 0;  ///< pseudo-random, the same in every run: the first 1,000 that are found in the model count
  double height = 0;       ///< m, over the line through its neighbours
};

/// By the id of a body that is a whole building.
struct PositionSample {
  std::string source;  ///< in words: where the positions are from
  std::unordered_map<std::string, std::vector<SampledCorner>> corners;
  /// m, by the same ids: how far the build says that repair moved a corner at most. Absent: none.
  std::unordered_map<std::string, double> reach;
  /// Middle of the sampled places; degrees.
  double lon = 0, lat = 0;
  double west = 0, south = 0, east = 0, north = 0;
  bool empty() const { return corners.empty(); }
};

/// Collects candidates and keeps those of the lowest ranks.
class PositionSampler {
 public:
  /// Adds the clear corners of an outer ring: those that no stage takes for a point on a straight wall. Turns below 10
  /// degrees and corners at edges shorter than 0.5 m are left out.
  /// \param ring  without a repeated last point
  void add(const std::string& body, const std::vector<model::Location>& ring);
  PositionSample finish(std::string source) &&;

 private:
  struct Candidate {
    std::uint64_t rank;
    std::string body;
    model::Location at;
    double height = 0;  ///< m
  };
  void shrink();
  std::vector<Candidate> candidates_;
};

inline constexpr std::size_t kPositions = 1000;  ///< of them are compared
/// More are sampled: not every one stands in the model as a body of its own.
inline constexpr std::size_t kSampled = 6000;

/// From an extract. Buildings in `mended` are left out: their corners may have been moved.
/// \param bbox  of the build
/// \throws base::InputError
PositionSample sample_extract(const std::string& path, const std::optional<std::array<double, 4>>& bbox,
                              const std::set<std::string>& mended);

/// From the records below FOLDER/explain. Lines that cannot be read are passed over: another check finds them.
PositionSample sample_explanations(const std::vector<std::string>& paths, const std::set<std::string>& mended);

/// What a build says of the repair of one building.
struct RepairSaid {
  double max_shift = 0;   ///< m, no corner of the outline moved farther
  bool reshaped = false;  ///< overlaps were cut off: corners may be gone
};
/// By building; those without a record are absent.
using RepairsSaid = std::unordered_map<std::string, RepairSaid>;

/// From the records below FOLDER/explain. \param wanted  only of these bodies
RepairsSaid repairs_of_explanations(const std::vector<std::string>& paths, const PositionSample& wanted);

/// Fills PositionSample::reach. Bodies that were reshaped are left out, as are those of `moved` without a record: where
/// their corners belong is not known.
/// \param moved      buildings of which the report says that repair moved corners
/// \param otherwise  m, how far repair may have moved corners of the others without a record
void bound_positions(PositionSample& sample, const RepairsSaid& said, const std::set<std::string>& moved,
                     double otherwise);

/// How an aerial image moved a building: turned about `centre`, then shifted; m and degrees in the build CRS. Then walls: what lies
/// nearest to the wall from `begin` to `end` went, beside that, as far as its ends did, in proportion.
struct MovementSaid {
  struct Wall {
    model::Point2 begin, end;        ///< m, as mapped
    model::Point2 begin_by, end_by;  ///< m
  };
  model::Point2 shift, centre;
  double turn = 0;
  std::vector<Wall> walls{};
  model::Point2 rigid(model::Point2 p) const;
  model::Point2 operator()(model::Point2 p) const;
};

/// The buildings that a build says it moved. \param imagery  its imagery.json
std::unordered_map<std::string, MovementSaid> movements_said(const Json& imagery);

/// Puts the sampled corners where the build says it moved them. Where moved places were rounded is allowed for.
void move_positions(PositionSample& sample, const std::unordered_map<std::string, MovementSaid>& moved,
                    georef::ProjTransform& proj_transform);

/// What the offsets of all corners have in common. Repair moves corners to and fro: the median over buildings (of their
/// mean offset, east and north apart) stays near zero unless everything was moved.
struct CommonShift {
  model::Point2 median;    ///< m east and north
  double uncertainty = 0;  ///< m: three standard errors of the median, from the spread of the buildings
  std::size_t buildings = 0;
};
/// \param offsets  m, with the building; those of one building stand together
CommonShift common_shift(std::span<const std::pair<std::string, model::Point2>> offsets);

}  // namespace blockrand::validate
