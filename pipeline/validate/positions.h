// Places of OpenStreetMap nodes, sampled for the check of the georeference.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::validate {

/// A corner of an outline as OpenStreetMap has it.
struct SampledCorner {
  model::Location at;
  std::uint64_t rank = 0;  ///< pseudo-random, the same in every run: the first 1,000 that are found in the model count
};

/// By the id of a body that is a whole building.
struct PositionSample {
  std::string source;  ///< in words: where the positions are from
  std::unordered_map<std::string, std::vector<SampledCorner>> corners;
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

}  // namespace blockrand::validate
