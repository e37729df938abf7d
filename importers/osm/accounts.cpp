#include "importers/osm/accounts.h"

#include <algorithm>
#include <charconv>
#include <unordered_map>
#include <unordered_set>

#include "importers/osm/equal_outlines.h"
#include "pipeline/model/osm_keys.h"

namespace blockrand::importers::osm {
namespace {

namespace osm_key = model::osm_key;
using model::IssueCode;
using model::ObjectKind;
using model::ObjectState;
using model::OsmId;
using model::OsmType;

template <class... Words>
bool is_any_of(std::string_view text, Words... words) {
  return ((text == words) || ...);
}

bool is_lifecycle(std::string_view use) {
  return is_any_of(use, "construction", "proposed", "planned", "demolished", "razed", "destroyed", "removed",
                   "dismantled", "collapsed");
}

bool is_underground(const RawData& data, const RawObject& object, std::string_view use) {
  if (is_any_of(data.tag(object, osm_key::kLocation), "underground", "underwater")) return true;
  const std::string_view text = data.tag(object, osm_key::kLayer);
  if (!text.starts_with('-')) return false;
  int layer = 0;
  std::from_chars(text.data(), text.data() + text.size(), layer);
  if (layer >= 0 || is_any_of(use, "roof", "bridge", "viaduct")) return false;
  if (data.tag(object, osm_key::kTunnel) == "yes") return true;
  if (layer > -2) return false;
  for (const std::string_view key :
       {osm_key::kHeight, osm_key::kBuildingHeight, osm_key::kBuildingLevels, osm_key::kLevels})
    if (const auto value = data.tag(object, key); !value.empty() && value != "0") return false;
  return true;
}

class Bookkeeper {
 public:
  explicit Bookkeeper(const RawData& data) : data_(data) {}

  Accounts run() {
    open();
    settle_relations();
    settle_old_style();
    settle_lifecycle();
    settle_equal_outlines();
    settle_building_relations();
    settle_chains();
    return std::move(out_);
  }

 private:
  void open() {
    std::size_t count = 0;
    const auto add = [&](const RawObject& raw, OsmType type) -> Account* {
      if (!raw.interest.is_building()) return nullptr;
      Account a;
      a.id = a.geometry_from = {type, raw.id};
      a.kind = raw.interest.building ? ObjectKind::building : ObjectKind::building_part;
      a.raw = &raw;
      out_.list.push_back(a);
      return &out_.list.back();
    };
    for (const auto& n : data_.nodes) count += n.interest.is_building();
    for (const auto& w : data_.ways) count += w.interest.is_building();
    for (const auto& r : data_.relations) count += r.interest.is_building();
    out_.list.reserve(count);
    for (const RawNode& node : data_.nodes)
      if (Account* a = add(node, OsmType::node)) {
        if (is_known(node.location))
          reject(*a, IssueCode::node_only, "");
        else
          reject(*a, IssueCode::invalid_location, "a point without a usable position");
      }
    for (const RawWay& way : data_.ways)
      if (Account* a = add(way, OsmType::way)) {
        Area own = assemble_way(data_, way);
        if (own.rings.empty()) reject(*a, own.code, own.detail);
      }
    for (const RawRelation& relation : data_.relations) add(relation, OsmType::relation);
  }

  void reject(Account& account, IssueCode code, std::string detail) {
    account.state = ObjectState::reported;
    account.code = code;
    if (detail.empty())
      out_.details.erase(account.id);
    else
      out_.details[account.id] = std::move(detail);
  }

  void merge_into(Account& account, OsmId master) {
    account.state = ObjectState::duplicate;
    account.code = IssueCode::none;
    account.related = master;
    account.area = -1;
    out_.details.erase(account.id);
  }

  void give_area(Account& account, Area area, OsmId from) {
    account.state = ObjectState::pending;
    account.code = IssueCode::none;
    account.geometry_from = from;
    out_.details.erase(account.id);
    if (area.code != IssueCode::none) out_.notices.push_back({account.id, area.code, area.detail});
    account.area = static_cast<std::int32_t>(out_.areas.size());
    out_.areas.push_back(std::move(area));
  }

  /// The member ways of a relation that have an account, each with the ring it runs along.
  struct TaggedMember {
    Account* account;
    const RawWay* way;
    int ring;  ///< of the area; -1 for none
  };
  std::vector<TaggedMember> tagged_members(const RawRelation& relation, const Area& area) {
    std::vector<TaggedMember> out;
    std::vector<WayLine> lines;
    std::vector<Role> roles;
    std::unordered_set<std::int64_t> seen;
    for (const RawMember& m : data_.members_of(relation)) {
      if (m.type != OsmType::way || !seen.insert(m.ref).second) continue;
      Account* account = out_.find({OsmType::way, m.ref});
      if (account == nullptr) continue;
      const auto* way = static_cast<const RawWay*>(account->raw);
      out.push_back({account, way, -1});
      lines.push_back(locate(data_, *way));
      roles.push_back(m.role);
    }
    const std::vector<int> rings = rings_along(area, lines);
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].ring = rings[i];
      // A way whose segments cancelled out with another's: its role must do.
      if (rings[i] < 0 && (roles[i] == Role::outer || roles[i] == Role::none) && !area.rings.empty()) out[i].ring = 0;
    }
    std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.account->id < b.account->id; });
    return out;
  }

  void settle_relations() {
    for (const RawRelation& relation : data_.relations) {
      Account* account = relation.interest.is_building() ? out_.find({OsmType::relation, relation.id}) : nullptr;
      if (account == nullptr || relation.type == RelationType::building) continue;
      const bool area_type = relation.type == RelationType::multipolygon || relation.type == RelationType::boundary;
      Area area = assemble_relation(data_, relation, relation.type == RelationType::other);
      if (area.rings.empty()) {
        const auto members = data_.members_of(relation);
        const bool shaped = std::any_of(members.begin(), members.end(), [](const RawMember& m) {
          return m.role == Role::outer || m.role == Role::outline;
        });
        if (area_type || shaped)
          reject(*account, area.code, area.detail);
        else
          reject(*account, IssueCode::relation_type, "type=" + std::string(data_.tag(relation, osm_key::kType)));
        if (area_type) explain_open_members(relation, area);
        continue;
      }
      std::size_t outer_rings = 0;
      for (const AreaRing& ring : area.rings) outer_rings += !ring.inner;
      for (const TaggedMember& member : tagged_members(relation, area)) {
        if (member.ring < 0 || area.rings[member.ring].inner || member.account->kind != account->kind) continue;
        if (member.account->state == ObjectState::duplicate) continue;
        merge_into(*member.account, account->id);
        if (outer_rings == 1 && account->tags_also_from == nullptr && member.way->refs.count > 3 &&
            data_.refs_of(*member.way).front() == data_.refs_of(*member.way).back()) {
          account->tags_also_from = member.way;
          note_conflicts(*account, *member.way);
        }
      }
      give_area(*account, std::move(area), account->id);
    }
  }

  void note_conflicts(const Account& account, const RawWay& way) {
    for (const std::string_view key :
         {osm_key::kHeight, osm_key::kBuildingLevels, osm_key::kRoofLevels, osm_key::kRoofShape}) {
      const auto ours = data_.tag(*account.raw, key), theirs = data_.tag(way, key);
      if (!ours.empty() && !theirs.empty() && ours != theirs)
        out_.notices.push_back({account.id, IssueCode::values_conflict,
                                std::string(key) + "=" + std::string(ours) + ", w" + std::to_string(way.id) + " says " +
                                    std::string(theirs)});
    }
  }

  /// "Not closed" is no news of a way that is only a piece of a multipolygon's outline.
  void explain_open_members(const RawRelation& relation, const Area& area) {
    for (const RawMember& m : data_.members_of(relation)) {
      if (m.type != OsmType::way || m.role == Role::inner) continue;
      Account* account = out_.find({OsmType::way, m.ref});
      if (account != nullptr && account->state == ObjectState::reported && account->code == IssueCode::open_way)
        reject(*account, area.code, "r" + std::to_string(relation.id) + ": " + area.detail);
    }
  }

  void settle_old_style() {
    for (const RawRelation& relation : data_.relations) {
      if (relation.type != RelationType::multipolygon || relation.interest.is_building()) continue;
      bool tagged = false, tagged_outer = false, any_outer = false;
      for (const RawMember& m : data_.members_of(relation)) {
        if (m.type != OsmType::way) continue;
        any_outer = any_outer || m.role != Role::inner;
        if (out_.find({OsmType::way, m.ref}) == nullptr) continue;
        tagged = true;
        tagged_outer = tagged_outer || m.role != Role::inner;
      }
      if (!tagged || (any_outer && !tagged_outer)) continue;
      Area area = assemble_relation(data_, relation);
      if (area.rings.empty())
        explain_open_members(relation, area);
      else
        share_out(relation, area);
    }
  }

  /// Gives the outer rings of an old-style multipolygon, with their inner rings, to its tagged outer ways.
  void share_out(const RawRelation& relation, const Area& area) {
    struct Owner {
      Account* account;
      std::vector<int> outer_rings;
    };
    std::vector<Owner> owners;
    std::unordered_set<int> owned;
    const OsmId relation_id{OsmType::relation, relation.id};
    for (const TaggedMember& member : tagged_members(relation, area)) {
      Account& account = *member.account;
      if (member.ring < 0 || area.rings[member.ring].inner) continue;
      if (account.state == ObjectState::duplicate || account.area >= 0) continue;  // another relation was first
      Owner* on_ring = nullptr;
      Owner* same = nullptr;
      for (Owner& owner : owners) {
        if (owner.account->kind != account.kind) continue;
        if (std::find(owner.outer_rings.begin(), owner.outer_rings.end(), member.ring) != owner.outer_rings.end())
          on_ring = &owner;
        if (same == nullptr && same_tags(data_, *owner.account->raw, *account.raw)) same = &owner;
      }
      if (on_ring != nullptr) {
        merge_into(account, on_ring->account->id);
      } else if (same != nullptr) {
        same->outer_rings.push_back(member.ring);
        merge_into(account, same->account->id);
      } else {
        owners.push_back({&account, {member.ring}});
      }
      owned.insert(member.ring);
    }
    if (owners.empty()) return;
    ++out_.old_style_multipolygons;
    old_style_owner_.emplace(relation.id, owners.front().account->id);
    for (int i = 0; i < static_cast<int>(area.rings.size()); ++i)
      if (!area.rings[i].inner && !owned.contains(i)) owners.front().outer_rings.push_back(i);
    for (Owner& owner : owners) {
      Area share;
      share.code = area.code;
      share.detail = area.detail;
      std::sort(owner.outer_rings.begin(), owner.outer_rings.end());
      for (const int o : owner.outer_rings)
        for (std::size_t i = static_cast<std::size_t>(o); i < area.rings.size(); ++i) {
          if (i > static_cast<std::size_t>(o) && !area.rings[i].inner) break;
          share.rings.push_back(area.rings[i]);
        }
      out_.notices.push_back({owner.account->id, IssueCode::old_style_multipolygon, relation_id.text()});
      give_area(*owner.account, std::move(share), relation_id);
    }
  }

  void settle_lifecycle() {
    for (Account& account : out_.list) {
      if (account.state != ObjectState::pending) continue;
      const std::string_view key = account.kind == ObjectKind::building ? osm_key::kBuilding : osm_key::kBuildingPart;
      const std::string_view use = data_.tag(*account.raw, key);
      if (is_lifecycle(use))
        reject(account, IssueCode::lifecycle, std::string(key) + "=" + std::string(use));
      else if (is_underground(data_, *account.raw, use))
        reject(account, IssueCode::underground,
               "layer=" + std::string(data_.tag(*account.raw, osm_key::kLayer)) +
                   ", location=" + std::string(data_.tag(*account.raw, osm_key::kLocation)));
    }
  }

  void settle_equal_outlines() {
    for (const auto& group : equal_outlines(data_, out_)) {
      const auto stronger = [&](const Account* a, const Account* b) {
        if (a->raw->tags.count != b->raw->tags.count) return a->raw->tags.count > b->raw->tags.count;
        return a->id < b->id;
      };
      Account* const master = *std::min_element(group.begin(), group.end(), stronger);
      for (Account* account : group)
        if (account != master) merge_into(*account, master->id);
    }
  }

  OsmId final_of(OsmId id) const {
    const Account* account = out_.find(id);
    for (int steps = 0; account != nullptr && account->state == ObjectState::duplicate && steps < 16; ++steps) {
      id = account->related;
      account = out_.find(id);
    }
    return id;
  }

  /// The account behind a member: its own, or for an old-style multipolygon that of its way.
  Account* account_of(const RawMember& member) {
    OsmId id{member.type, member.ref};
    if (member.type == OsmType::relation)
      if (const auto found = old_style_owner_.find(member.ref); found != old_style_owner_.end()) id = found->second;
    return out_.find(final_of(id));
  }

  void settle_building_relations() {
    for (const RawRelation& relation : data_.relations) {
      if (relation.type != RelationType::building) continue;
      Account* const own = out_.find({OsmType::relation, relation.id});
      model::BuildingRelation entry;
      entry.id = {OsmType::relation, relation.id};
      Account* outline = nullptr;
      bool absent = false;
      std::vector<RawMember> shape;
      std::vector<OsmId> without_role;
      for (const RawMember& m : data_.members_of(relation)) {
        if (m.type == OsmType::node) continue;
        Account* const account = account_of(m);
        const bool in_file = account != nullptr ||
                             (m.type == OsmType::way ? data_.way(m.ref) != nullptr : data_.relation(m.ref) != nullptr);
        const bool is_outline = m.role == Role::outline || m.role == Role::outer;
        if (is_outline || m.role == Role::part || m.role == Role::none) absent = absent || !in_file;
        if (is_outline || m.role == Role::inner) shape.push_back(m);
        if (account == nullptr || account == own) continue;
        if (is_outline && (outline == nullptr || account->id < outline->id))
          outline = account;
        else if (m.role == Role::part || account->kind == ObjectKind::building_part)
          entry.parts.push_back(account->id);
        else if (m.role == Role::none)
          without_role.push_back(account->id);
      }
      std::sort(without_role.begin(), without_role.end());
      without_role.erase(std::unique(without_role.begin(), without_role.end()), without_role.end());
      // One building among members without roles is the outline; several together are the building.
      if (outline == nullptr && shape.empty() && without_role.size() == 1) outline = out_.find(without_role.front());
      std::sort(entry.parts.begin(), entry.parts.end());
      entry.parts.erase(std::unique(entry.parts.begin(), entry.parts.end()), entry.parts.end());
      if (outline != nullptr)
        entry.outline = outline->state == ObjectState::represented ? outline->related : outline->id;
      if (own != nullptr) settle_own_tags(relation, *own, outline, shape, absent, entry.parts, without_role);
      if (own != nullptr && own->state == ObjectState::pending) entry.outline = own->id;
      if (entry.outline.number != 0 || !entry.parts.empty()) out_.building_relations.push_back(std::move(entry));
    }
  }

  void settle_own_tags(const RawRelation& relation, Account& own, const Account* outline,
                       const std::vector<RawMember>& shape, bool absent, const std::vector<OsmId>& parts,
                       const std::vector<OsmId>& without_role) {
    const auto represent = [&](OsmId by) {
      own.state = ObjectState::represented;
      own.related = by;
    };
    if (outline != nullptr && outline->state == ObjectState::pending) return represent(outline->id);
    if (outline != nullptr && outline->state == ObjectState::represented) return represent(outline->related);
    Area area;
    OsmId from = own.id;
    if (outline == nullptr && !shape.empty()) {
      if (shape.size() == 1) from = {shape.front().type, shape.front().ref};
      if (shape.front().type == OsmType::relation) {
        if (const RawRelation* r = data_.relation(shape.front().ref)) area = assemble_relation(data_, *r);
      } else {
        area = assemble_members(data_, relation.id, shape);
      }
    }
    if (!area.rings.empty()) return give_area(own, std::move(area), from);
    for (const auto* members : {&parts, &without_role})
      for (const OsmId member : *members) {
        const Account* a = out_.find(member);
        if (a != nullptr && a->state == ObjectState::represented) a = out_.find(a->related);
        if (a != nullptr && a != &own && a->state == ObjectState::pending) return represent(a->id);
      }
    if (outline != nullptr && outline->state == ObjectState::reported)
      return reject(own, outline->code, "so is its outline " + outline->id.text());
    if (absent || area.code == IssueCode::outline_incomplete)
      return reject(own, IssueCode::outline_incomplete,
                    area.detail.empty() ? "outline or parts are not in the file" : area.detail);
    if (area.code != IssueCode::none) return reject(own, area.code, area.detail);
    reject(own, IssueCode::relation_type, "type=building without an outline or parts");
  }

  void settle_chains() {
    for (Account& account : out_.list)
      if (account.state == ObjectState::duplicate || account.state == ObjectState::represented)
        account.related = final_of(account.related);
  }

  const RawData& data_;
  Accounts out_;
  std::unordered_map<std::int64_t, OsmId> old_style_owner_;  ///< by relation number
};

}  // namespace

const Account* Accounts::find(OsmId id) const {
  const auto found = std::lower_bound(list.begin(), list.end(), id, [](const Account& a, OsmId i) { return a.id < i; });
  return found == list.end() || found->id != id ? nullptr : &*found;
}

Accounts open_accounts(const RawData& data) { return Bookkeeper(data).run(); }

bool same_tags(const RawData& data, const RawObject& a, const RawObject& b) {
  const auto kept = [&](const RawObject& o) {
    std::vector<std::pair<base::StringId, base::StringId>> out;
    for (const model::Tag& t : data.tags_of(o))
      if (!is_remark(data.strings.view(t.key))) out.emplace_back(t.key, t.value);
    std::sort(out.begin(), out.end());
    return out;
  };
  return kept(a) == kept(b);
}

std::vector<int> rings_along(const Area& area, const std::vector<WayLine>& lines) {
  std::vector<int> out(lines.size(), -1);
  if (lines.empty()) return out;
  std::map<std::pair<model::Location, model::Location>, int> ring_of;
  for (std::size_t r = 0; r < area.rings.size(); ++r) {
    const auto& v = area.rings[r].vertices;
    for (std::size_t i = 0; i < v.size(); ++i)
      ring_of.emplace(std::minmax(v[i].location, v[(i + 1) % v.size()].location), static_cast<int>(r));
  }
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const auto& v = lines[l].vertices;
    for (std::size_t i = 0; i + 1 < v.size() && out[l] < 0; ++i)
      if (const auto found = ring_of.find(std::minmax(v[i].location, v[i + 1].location)); found != ring_of.end())
        out[l] = found->second;
  }
  return out;
}

}  // namespace blockrand::importers::osm
