#include "importers/osm/osm_features.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace blockrand::importers::osm {
namespace {

using model::IssueCode;
using model::ObjectState;
using model::OsmId;
using model::OsmType;

class Planner {
 public:
  Planner(const RawData& data, const Accounts& accounts, std::vector<model::ReportRow>& notices,
          const std::function<void(const PlannedFeature&)>& visit)
      : data_(data), accounts_(accounts), notices_(notices), visit_(visit) {}

  void run() {
    for (const RawNode& node : data_.nodes)
      if (node.interest.kinds != 0 && is_known(node.location)) {
        PlannedFeature f = feature(OsmType::node, node);
        f.rings.push_back({{{node.id, node.location}}, false});
        visit_(f);
      }
    std::vector<PlannedFeature> of_relations;
    for (const RawRelation& relation : data_.relations) {
      if (relation.type != RelationType::multipolygon && relation.type != RelationType::boundary) continue;
      if (relation.interest.kinds != 0) {
        if (is_free({OsmType::relation, relation.id})) plan_relation(relation, of_relations);
      } else if (relation.type == RelationType::multipolygon && !relation.interest.is_building()) {
        plan_old_style(relation);
      }
    }
    for (const RawWay& way : data_.ways)
      if (way.interest.kinds != 0 && is_free({OsmType::way, way.id}) && !left_out_.contains(way.id)) plan_way(way);
    for (const PlannedFeature& f : of_relations) visit_(f);
  }

 private:
  static PlannedFeature feature(OsmType type, const RawObject& raw) {
    PlannedFeature f;
    f.id = {type, raw.id};
    f.raw = &raw;
    f.kinds = raw.interest.kinds;
    return f;
  }

  bool is_free(OsmId id) const {
    const Account* account = accounts_.find(id);
    return account == nullptr || account->state == ObjectState::reported;
  }

  void plan_relation(const RawRelation& relation, std::vector<PlannedFeature>& out) {
    PlannedFeature f = feature(OsmType::relation, relation);
    Area area = assemble_relation(data_, relation);
    f.area = !area.rings.empty();
    if (f.area) {
      if (area.code != IssueCode::none) notices_.push_back({f.id, area.code, area.detail});
      f.rings = std::move(area.rings);
    } else {
      const bool lost = area.code == IssueCode::outline_incomplete || area.code == IssueCode::invalid_location;
      for (const RawMember& m : data_.members_of(relation))
        if (const RawWay* way = m.type == OsmType::way ? data_.way(m.ref) : nullptr) add_lines(*way, f.rings);
      if (f.rings.empty()) return;
      notices_.push_back(
          {f.id, lost ? IssueCode::members_missing : IssueCode::relation_repaired, "kept as lines; " + area.detail});
    }
    for (const RawMember& m : data_.members_of(relation))
      if (m.type == OsmType::way)
        if (const RawWay* way = data_.way(m.ref); way != nullptr && says_no_more(*way, relation))
          left_out_.insert(way->id);
    out.push_back(std::move(f));
  }

  /// Whether every tag of the way, remarks aside, is one of the relation's.
  bool says_no_more(const RawWay& way, const RawRelation& relation) const {
    const auto known = data_.tags_of(relation);
    for (const model::Tag& t : data_.tags_of(way)) {
      if (is_remark(data_.strings.view(t.key))) continue;
      if (std::none_of(known.begin(), known.end(),
                       [&](const model::Tag& k) { return k.key == t.key && k.value == t.value; }))
        return false;
    }
    return true;
  }

  void plan_old_style(const RawRelation& relation) {
    std::vector<const RawWay*> tagged;
    std::unordered_set<std::int64_t> seen;
    for (const RawMember& m : data_.members_of(relation)) {
      if (m.type != OsmType::way || !seen.insert(m.ref).second) continue;
      const RawWay* way = data_.way(m.ref);
      if (way != nullptr && way->interest.area_by_tag && !way->interest.line_by_tag && way->interest.kinds != 0 &&
          is_free({OsmType::way, way->id}))
        tagged.push_back(way);
    }
    if (tagged.empty()) return;
    const Area area = assemble_relation(data_, relation);
    if (area.rings.empty()) return;
    std::sort(tagged.begin(), tagged.end(), [](const RawWay* a, const RawWay* b) { return a->id < b->id; });
    std::vector<WayLine> lines;
    for (const RawWay* way : tagged) lines.push_back(locate(data_, *way));
    const std::vector<int> rings = rings_along(area, lines);
    std::vector<std::pair<const RawWay*, std::unordered_set<int>>> owners;
    for (std::size_t i = 0; i < tagged.size(); ++i) {
      if (rings[i] < 0 || area.rings[rings[i]].inner || area_of_.contains(tagged[i]->id)) continue;
      const auto same = std::find_if(owners.begin(), owners.end(),
                                     [&](const auto& o) { return same_tags(data_, *o.first, *tagged[i]); });
      if (same == owners.end()) {
        owners.push_back({tagged[i], {rings[i]}});
      } else {
        same->second.insert(rings[i]);
        left_out_.insert(tagged[i]->id);
      }
    }
    for (const auto& [way, outer_rings] : owners) {
      std::vector<AreaRing>& own = area_of_[way->id];
      bool take = false;
      for (std::size_t r = 0; r < area.rings.size(); ++r) {
        if (!area.rings[r].inner) take = outer_rings.contains(static_cast<int>(r));
        if (take) own.push_back(area.rings[r]);
      }
      for (std::size_t i = 0; i < tagged.size(); ++i)  // an inner way with the outer way's tags only marks the hole
        if (rings[i] >= 0 && area.rings[rings[i]].inner && same_tags(data_, *way, *tagged[i]))
          left_out_.insert(tagged[i]->id);
    }
  }

  void plan_way(const RawWay& way) {
    PlannedFeature f = feature(OsmType::way, way);
    if (const auto found = area_of_.find(way.id); found != area_of_.end()) {
      f.area = true;
      f.rings = std::move(found->second);
    } else if (way.interest.area()) {
      Area area = assemble_way(data_, way);
      f.area = !area.rings.empty();
      f.rings = std::move(area.rings);
    }
    if (!f.area) add_lines(way, f.rings);
    if (!f.rings.empty()) visit_(f);
  }

  void add_lines(const RawWay& way, std::vector<AreaRing>& rings) const {
    bool gap = true;
    for (const std::int64_t ref : data_.refs_of(way)) {
      const model::Location location = data_.positions.find(ref);
      if (!is_known(location)) {
        gap = true;
        continue;
      }
      if (gap) rings.push_back({});
      gap = false;
      rings.back().vertices.push_back({ref, location});
    }
  }

  const RawData& data_;
  const Accounts& accounts_;
  std::vector<model::ReportRow>& notices_;
  const std::function<void(const PlannedFeature&)>& visit_;
  std::unordered_map<std::int64_t, std::vector<AreaRing>> area_of_;  ///< rings of old-style ways
  std::unordered_set<std::int64_t> left_out_;                        ///< ways
};

}  // namespace

void for_each_feature(const RawData& data, const Accounts& accounts, std::vector<model::ReportRow>& notices,
                      const std::function<void(const PlannedFeature&)>& visit) {
  Planner(data, accounts, notices, visit).run();
}

}  // namespace blockrand::importers::osm
