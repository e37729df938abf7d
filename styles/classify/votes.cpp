#include "styles/classify/votes.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"

namespace blockrand::classify {

Siting siting_of(model::BuildingPosition position) {
  switch (position) {
    case model::BuildingPosition::unknown:
      return Siting::unknown;
    case model::BuildingPosition::rear_building:
    case model::BuildingPosition::side_wing:
      return Siting::behind;
    case model::BuildingPosition::free_standing:
    case model::BuildingPosition::end_of_row:
    case model::BuildingPosition::mid_row:
    case model::BuildingPosition::corner_house:
      break;
  }
  return Siting::front;
}

VoteKernel VoteKernel::read(base::TomlTable& table) {
  VoteKernel k;
  k.reach = table.number("reach", 1, 250).value_or(k.reach);
  k.distance = table.number("distance", 1, 1000).value_or(k.distance);
  k.area = table.number("area", 0, 5).value_or(k.area);
  k.other_standing = table.number("other_standing", 0, 1).value_or(k.other_standing);
  k.touching = table.number("touching", 0, 100).value_or(k.touching);
  k.same_block = table.number("same_block", 0, 100).value_or(k.same_block);
  k.same_street = table.number("same_street", 0, 100).value_or(k.same_street);
  k.other_use = table.number("other_use", 0, 1).value_or(k.other_use);
  k.prior = table.number("prior", 1e-6, 1000).value_or(k.prior);
  table.finish();
  return k;
}

double VoteKernel::weight(const Voter& asker, const Voter& asked, bool touches) const {
  const double dx = asker.place.x - asked.place.x, dy = asker.place.y - asked.place.y;
  const double away = std::sqrt(dx * dx + dy * dy);
  if (away > reach) return 0;
  double log_weight = -away / distance;
  if (asker.area > 0 && asked.area > 0) log_weight -= area * std::fabs(base::log(asker.area / asked.area));
  double w = base::exp(log_weight);
  const bool stand_alike =
      asker.siting == asked.siting || asker.siting == Siting::unknown || asked.siting == Siting::unknown;
  if (!stand_alike) w *= other_standing;
  if (touches) w *= touching;
  if (asker.block == asked.block && asker.block != model::kNoIndex) w *= same_block;
  if (asker.street == asked.street && asker.street != 0) w *= same_street;
  if (asker.use != asked.use && asker.use != 0 && asked.use != 0) w *= other_use;
  return w;
}

PerAnswer posterior(const PerAnswer& votes, const PerAnswer& own, const VoteKernel& kernel, std::size_t n) {
  double all = kernel.prior;
  for (std::size_t a = 0; a < n; ++a) all += votes[a];
  PerAnswer p{};
  for (std::size_t a = 0; a < n; ++a) p[a] = std::floor((votes[a] + kernel.prior * own[a]) / all * 65536 + 0.5) / 65536;
  return p;
}

}  // namespace blockrand::classify
