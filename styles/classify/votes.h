// What tagged neighbours say of a building that is not tagged, weighed by how alike they are.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "pipeline/base/toml_file.h"
#include "pipeline/model/building.h"
#include "styles/classify/evidence_model.h"

namespace blockrand::classify {

/// How a house stands, as far as neighbours are alike by it.
enum class Siting : std::uint8_t { unknown, front, behind };
Siting siting_of(model::BuildingPosition position);

/// Who asks and who is asked.
struct Voter {
  model::Point2 place;  ///< m
  double area = 0;      ///< m²
  Siting siting = Siting::unknown;
  std::uint64_t street = 0;  ///< 0: on none
  std::uint32_t block = model::kNoIndex;
  std::uint8_t use = 0;  ///< Feature::tag_use; 0: untold
};

/// A voter's weight is the product of these. Where they come from stands in configs/styles/neighbours.toml.
struct VoteKernel {
  double reach = 150;            ///< m; farther ones are not asked
  double distance = 40;          ///< m over which the weight falls by e
  double area = 0.7;             ///< power of the ratio of footprints, smaller over larger
  double other_standing = 0.35;  ///< a house behind speaks less of a front house, and the other way round
  double touching = 4;           ///< they have a wall in common
  double same_block = 1.5;
  double same_street = 1.5;
  double other_use = 0.5;  ///< both tell their use, and they differ
  double prior = 0.3;      ///< votes that the building's own evidence counts for

  /// Reads a table with these keys, all optional.
  static VoteKernel read(base::TomlTable& table);
  double weight(const Voter& asker, const Voter& asked, bool touches) const;
};

/// Votes and own evidence together (a Dirichlet prior of `kernel.prior` votes):
/// p(a) = (votes(a) + prior x own(a)) / (all votes + prior). \param n  answers
PerAnswer posterior(const PerAnswer& votes, const PerAnswer& own, const VoteKernel& kernel, std::size_t n);

}  // namespace blockrand::classify
