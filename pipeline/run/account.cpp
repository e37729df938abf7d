#include "pipeline/run/account.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <utility>

namespace blockrand::run {

using model::IssueCode;
using model::MappedBuilding;
using model::ObjectState;

Account::Account(model::Extract& extract, std::vector<model::ReportRow> rows)
    : extract_(extract), rows_(std::move(rows)), decided_(extract.buildings.size(), 0) {
  std::vector<model::ReportRow>& read = extract.report.rows;
  rows_.insert(rows_.end(), std::make_move_iterator(read.begin()), std::make_move_iterator(read.end()));
  for (const model::ReportRow& row : rows_)
    if (row.code == IssueCode::members_missing) incomplete_.insert(row.object);
  std::sort(rows_.begin(), rows_.end());
  earlier_ = rows_;
}

outputs::FinalState Account::final_state_of(const Outcome& o, const model::Extract& extract) const {
  // Where members of a relation are missing, that is why nothing is enclosed.
  const bool no_area = o.code == IssueCode::zero_area || o.code == IssueCode::too_few_points;
  const bool lacks_members = no_area && incomplete_.contains(extract.buildings[o.index].id);
  return {o.state, lacks_members ? IssueCode::outline_incomplete : o.code, o.related};
}

std::function<outputs::FinalState(std::uint32_t)> Account::final_states(const std::vector<Outcome>& outcomes,
                                                                        const model::Extract& extract) const {
  std::map<std::uint32_t, outputs::FinalState> final_states;
  for (const Outcome& o : outcomes) final_states[o.index] = final_state_of(o, extract);
  return [final_states = std::move(final_states)](std::uint32_t index) {
    const auto found = final_states.find(index);
    return found == final_states.end() ? outputs::FinalState{} : found->second;
  };
}

void Account::take(const Outcomes& outcomes, std::vector<model::ReportRow> rows, BuildSummary& summary) {
  for (const Outcome& o : outcomes.list) {
    MappedBuilding& object = extract_.buildings[o.index];
    const outputs::FinalState final_state = final_state_of(o, extract_);
    decided_[o.index] = 1;
    object.state = final_state.state;
    object.code = final_state.code;
    object.related = final_state.related;
    if (o.state == ObjectState::modelled) ++summary.models_by_lod[static_cast<std::size_t>(std::clamp(o.lod, 0, 3))];
  }
  std::move(rows.begin(), rows.end(), std::back_inserter(rows_));
  summary.below_quality = summary.below_quality || outcomes.below_quality;
}

void Account::close(const std::optional<TileChoice>& tile, std::span<const footprints::Shard> shards,
                    std::span<const std::size_t> todo, BuildSummary& summary) {
  if (tile) {
    // Objects of a seed are decided with it: those of other tiles are not looked for here.
    for (const footprints::Shard& shard : shards)
      for (const footprints::Seed& seed : shard.seeds) {
        const auto leave = [&](std::uint32_t index) {
          if (extract_.buildings[index].state == ObjectState::pending) decided_[index] = 2;
        };
        if (seed.outline != model::kNoIndex) leave(seed.outline);
        std::ranges::for_each(seed.parts, leave);
      }
    for (const std::size_t built : todo)
      for (const footprints::Seed& seed : shards[built].seeds) {
        const auto claim = [&](std::uint32_t index) { decided_[index] = 1; };
        if (seed.outline != model::kNoIndex) claim(seed.outline);
        std::ranges::for_each(seed.parts, claim);
      }
    const auto is_here = [&](const MappedBuilding& b) {
      const std::uint8_t decided = decided_[static_cast<std::size_t>(&b - extract_.buildings.data())];
      return decided == 0 ? lies_in(extract_, b, *tile) : decided == 1;
    };
    forget_others(extract_, *tile, is_here, rows_);
  }
  for (MappedBuilding& b : extract_.buildings) {
    if (b.state == ObjectState::pending) {
      b.state = ObjectState::reported;
      b.code = IssueCode::unaccounted;
      summary.unaccounted.push_back(b.id.text());
    }
    ++(b.kind == model::ObjectKind::building ? summary.buildings_in : summary.parts_in);
    switch (b.state) {
      case ObjectState::modelled:
        ++summary.models;
        break;
      case ObjectState::duplicate:
        ++summary.duplicates;
        break;
      case ObjectState::represented:
        ++summary.represented;
        break;
      case ObjectState::pending:  // none is left
      case ObjectState::reported:
        ++summary.reported;
        break;
    }
    if (b.state == ObjectState::reported) ++summary.issues[std::string(info(b.code).text)];
  }
  std::sort(rows_.begin(), rows_.end());
  for (const model::ReportRow& row : rows_)
    if (info(row.code).issue_class != model::IssueClass::reported) ++summary.issues[std::string(info(row.code).text)];
}

}  // namespace blockrand::run
