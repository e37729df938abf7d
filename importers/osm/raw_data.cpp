#include "importers/osm/raw_data.h"

#include <algorithm>
#include <bit>
#include <osmium/osm/node.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/way.hpp>
#include <string>
#include <unordered_map>

#include "importers/osm/selection.h"

namespace blockrand::importers::osm {
namespace {

using Entity = osmium::osm_entity_bits::type;

std::uint32_t seconds(const osmium::OSMObject& object) {
  return object.timestamp().valid() ? static_cast<std::uint32_t>(object.timestamp()) : 0;
}

Role role_of(std::string_view text) {
  if (text.empty()) return Role::none;
  if (text == "outer") return Role::outer;
  if (text == "inner") return Role::inner;
  if (text == "outline") return Role::outline;
  if (text == "part") return Role::part;
  return Role::other;
}

class RawReader {
 public:
  RawReader(OsmFile& file, bool surroundings, const std::function<void(std::string_view, double)>& progress)
      : file_(file), surroundings_(surroundings), progress_(progress) {}

  RawData read() {
    read_relations();
    read_ways();
    read_nodes();
    return std::move(data_);
  }

 private:
  /// Calls `visit(object)` for what is there, and tells whether every id was higher than the one before.
  template <class Visit>
  bool pass(Entity type, std::string_view phase, std::uint64_t& count, Visit&& visit) {
    bool rising = true, first = true;
    std::int64_t last = 0;
    file_.for_each(
        type,
        [&](const osmium::OSMObject& object) {
          rising = rising && (first || object.id() > last);
          first = false;
          last = object.id();
          if (object.visible() && !file_.deleted_by_editor(object.type(), object.id())) {
            ++count;
            data_.newest = std::max(data_.newest, seconds(object));
            visit(object);
          } else {
            // Only the tags are looked at, so that a NUL is found in whichever order the objects come.
            for_each_tag(object, [](std::string_view, std::string_view) {});
          }
        },
        [&](double fraction) {
          if (progress_) progress_(phase, fraction);
        });
    return rising;
  }

  void keep(RawObject& raw, const osmium::OSMObject& object, const Interest& interest) {
    raw.id = object.id();
    raw.version = object.version();
    raw.timestamp = seconds(object);
    raw.interest = interest;
    raw.tags.first = static_cast<std::uint32_t>(data_.tags.size());
    for_each_tag(object, [&](std::string_view key, std::string_view value) {
      const base::StringId k = data_.strings.intern(key);
      data_.tags.push_back({k, data_.strings.intern(value)});
    });
    raw.tags.count = static_cast<std::uint32_t>(data_.tags.size()) - raw.tags.first;
  }

  /// Leaves the newest version of each object. Where versions tie, a rule that does not know the order of the file.
  template <class Raw, class SameContentBefore>
  void leave_newest(std::vector<Raw>& list, Entity type, SameContentBefore before) {
    std::unordered_map<std::int64_t, std::uint32_t> newest;
    newest.reserve(list.size());
    for (const Raw& raw : list) newest.emplace(raw.id, 0);
    file_.for_each(type,
                   [&](const osmium::OSMObject& object) {
                     if (file_.deleted_by_editor(object.type(), object.id())) return;
                     const auto found = newest.find(object.id());
                     if (found != newest.end()) found->second = std::max(found->second, object.version());
                   },
                   {});
    std::erase_if(list, [&](const Raw& raw) { return raw.version < newest[raw.id]; });
    std::stable_sort(list.begin(), list.end(), [&](const Raw& a, const Raw& b) {
      if (a.id != b.id) return a.id < b.id;
      if (a.timestamp != b.timestamp) return a.timestamp > b.timestamp;
      return before(a, b);
    });
    list.erase(std::unique(list.begin(), list.end(), [](const Raw& a, const Raw& b) { return a.id == b.id; }),
               list.end());
  }

  bool tags_before(const RawObject& a, const RawObject& b) const {
    const auto texts = [&](const RawObject& o) {
      std::vector<std::pair<std::string_view, std::string_view>> out;
      for (const model::Tag& t : data_.tags_of(o))
        out.emplace_back(data_.strings.view(t.key), data_.strings.view(t.value));
      std::sort(out.begin(), out.end());
      return out;
    };
    return texts(a) < texts(b);
  }

  void read_relations() {
    const bool rising = pass(osmium::osm_entity_bits::relation, "reading relations", data_.relation_count,
                             [&](const osmium::OSMObject& object) {
                               const auto& relation = static_cast<const osmium::Relation&>(object);
                               const Interest interest = interest_of(model::OsmType::relation, object, surroundings_);
                               const std::optional<RelationType> type = kept_as(relation, interest);
                               if (!type) return;
                               RawRelation raw;
                               keep(raw, object, interest);
                               raw.type = *type;
                               raw.members.first = static_cast<std::uint32_t>(data_.members.size());
                               for (const auto& member : relation.members()) {
                                 const auto member_type =
                                     member.type() == osmium::item_type::node  ? model::OsmType::node
                                     : member.type() == osmium::item_type::way ? model::OsmType::way
                                                                               : model::OsmType::relation;
                                 data_.members.push_back({member.ref(), member_type, role_of(member.role())});
                               }
                               raw.members.count = static_cast<std::uint32_t>(data_.members.size()) - raw.members.first;
                               data_.relations.push_back(raw);
                             });
    if (!rising)
      leave_newest(data_.relations, osmium::osm_entity_bits::relation, [&](const RawRelation& a, const RawRelation& b) {
        const auto key = [](const RawMember& m) { return std::tuple(m.ref, m.type, m.role); };
        const auto ma = data_.members_of(a), mb = data_.members_of(b);
        if (!std::equal(ma.begin(), ma.end(), mb.begin(), mb.end(), [&](auto& x, auto& y) { return key(x) == key(y); }))
          return std::lexicographical_compare(ma.begin(), ma.end(), mb.begin(), mb.end(),
                                              [&](auto& x, auto& y) { return key(x) < key(y); });
        return tags_before(a, b);
      });
  }

  void read_ways() {
    std::vector<std::int64_t> needed;
    for (const RawRelation& relation : data_.relations)
      for (const RawMember& member : data_.members_of(relation))
        if (member.type == model::OsmType::way) needed.push_back(member.ref);
    std::sort(needed.begin(), needed.end());
    needed.erase(std::unique(needed.begin(), needed.end()), needed.end());

    const bool rising =
        pass(osmium::osm_entity_bits::way, "reading ways", data_.way_count, [&](const osmium::OSMObject& object) {
          const auto& way = static_cast<const osmium::Way&>(object);
          const Interest interest = interest_of(model::OsmType::way, object, surroundings_);
          if (!is_kept(interest) && !std::binary_search(needed.begin(), needed.end(), way.id())) return;
          RawWay raw;
          keep(raw, object, interest);
          raw.refs.first = static_cast<std::uint32_t>(data_.refs.size());
          for (const auto& node : way.nodes()) data_.refs.push_back(node.ref());
          raw.refs.count = static_cast<std::uint32_t>(data_.refs.size()) - raw.refs.first;
          data_.ways.push_back(raw);
        });
    if (!rising)
      leave_newest(data_.ways, osmium::osm_entity_bits::way, [&](const RawWay& a, const RawWay& b) {
        const auto ra = data_.refs_of(a), rb = data_.refs_of(b);
        if (!std::equal(ra.begin(), ra.end(), rb.begin(), rb.end()))
          return std::lexicographical_compare(ra.begin(), ra.end(), rb.begin(), rb.end());
        return tags_before(a, b);
      });
  }

  void read_nodes() {
    std::vector<std::int64_t> needed;
    needed.reserve(data_.refs.size());
    for (const RawWay& way : data_.ways) {
      const auto refs = data_.refs_of(way);
      needed.insert(needed.end(), refs.begin(), refs.end());
    }
    data_.positions.build(std::move(needed));
    if (file_.ways_have_places()) {
      // Nodes without tags of interest are not in the file.
      file_.for_each(osmium::osm_entity_bits::way,
                     [&](const osmium::OSMObject& object) {
                       for (const osmium::NodeRef& node : static_cast<const osmium::Way&>(object).nodes())
                         if (const std::size_t slot = data_.positions.slot(node.ref()); slot != NodePositions::npos) {
                           const model::Location at{node.location().x(), node.location().y()};
                           if (at != kMissing) data_.positions.set(slot, is_known(at) ? at : kInvalid, 1);
                         }
                     },
                     {});
    }

    bool rising = true, first = true;
    std::int64_t last = 0;
    file_.for_each(
        osmium::osm_entity_bits::node,
        [&](const osmium::OSMObject& object) {
          const auto& node = static_cast<const osmium::Node&>(object);
          rising = rising && (first || node.id() > last);
          first = false;
          last = node.id();
          if (file_.deleted_by_editor(osmium::item_type::node, node.id())) return;
          const Interest interest = interest_of(model::OsmType::node, object, surroundings_);
          if (const std::size_t slot = data_.positions.slot(node.id());
              slot != NodePositions::npos && !file_.ways_have_places())
            data_.positions.set(slot, node.visible() ? position_of(node.location()) : kMissing, node.version());
          if (!node.visible()) return;
          ++data_.node_count;
          data_.newest = std::max(data_.newest, seconds(node));
          if (!is_kept(interest)) return;
          RawNode raw;
          keep(raw, object, interest);
          raw.location = position_of(node.location());
          data_.nodes.push_back(raw);
        },
        [&](double fraction) {
          if (progress_) progress_("reading nodes", fraction);
        });
    if (!rising)
      leave_newest(data_.nodes, osmium::osm_entity_bits::node, [&](const RawNode& a, const RawNode& b) {
        if (a.location != b.location) return a.location < b.location;
        return tags_before(a, b);
      });
  }

  OsmFile& file_;
  bool surroundings_;
  const std::function<void(std::string_view, double)>& progress_;
  RawData data_;
};

template <class List>
auto find_by_id(const List& list, std::int64_t id) -> decltype(list.data()) {
  const auto found =
      std::lower_bound(list.begin(), list.end(), id, [](const auto& o, std::int64_t i) { return o.id < i; });
  return found == list.end() || found->id != id ? nullptr : &*found;
}

}  // namespace

void NodePositions::build(std::vector<std::int64_t> ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  ids.shrink_to_fit();
  ids_ = std::move(ids);
  locations_.assign(ids_.size(), kMissing);
  versions_.assign(ids_.size(), 0);
  bucket_.clear();
  if (ids_.empty()) return;
  // About one stretch per id: most lookups then end after a few steps.
  base_ = static_cast<std::uint64_t>(ids_.front());
  const std::uint64_t span = static_cast<std::uint64_t>(ids_.back()) - base_;
  shift_ = std::max(0, static_cast<int>(std::bit_width(span)) - static_cast<int>(std::bit_width(ids_.size())));
  bucket_.assign((span >> shift_) + 2, 0);
  for (const std::int64_t id : ids_) ++bucket_[((static_cast<std::uint64_t>(id) - base_) >> shift_) + 1];
  for (std::size_t i = 1; i < bucket_.size(); ++i) bucket_[i] += bucket_[i - 1];
}

std::size_t NodePositions::slot(std::int64_t id) const {
  if (ids_.empty() || id < ids_.front() || id > ids_.back()) return npos;
  const std::uint64_t b = (static_cast<std::uint64_t>(id) - base_) >> shift_;
  const auto end = ids_.begin() + bucket_[b + 1];
  const auto found = std::lower_bound(ids_.begin() + bucket_[b], end, id);
  return found == end || *found != id ? npos : static_cast<std::size_t>(found - ids_.begin());
}

void NodePositions::set(std::size_t slot, model::Location location, std::uint32_t version) {
  model::Location& kept = locations_[slot];
  if (version < versions_[slot]) return;
  // Of equal versions the smaller position, so that the order of the file does not matter.
  if (version > versions_[slot] || kept == kMissing || location < kept) kept = location;
  versions_[slot] = version;
}

std::uint64_t NodePositions::count_missing() const {
  return static_cast<std::uint64_t>(std::count(locations_.begin(), locations_.end(), kMissing));
}

std::string_view RawData::tag(const RawObject& object, std::string_view key) const {
  for (const model::Tag& t : tags_of(object))
    if (strings.view(t.key) == key) return strings.view(t.value);
  return {};
}

const RawWay* RawData::way(std::int64_t id) const { return find_by_id(ways, id); }
const RawRelation* RawData::relation(std::int64_t id) const { return find_by_id(relations, id); }

RawData read_raw(OsmFile& file, bool surroundings,
                 const std::function<void(std::string_view phase, double fraction)>& progress) {
  return RawReader(file, surroundings, progress).read();
}

}  // namespace blockrand::importers::osm
