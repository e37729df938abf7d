#include "importers/osm/read_extract.h"

#include <algorithm>
#include <deque>
#include <optional>
#include <osmium/osm/timestamp.hpp>

#include "importers/osm/accounts.h"
#include "importers/osm/attributes.h"
#include "importers/osm/osm_features.h"
#include "importers/osm/read_file.h"
#include "importers/osm/text_cleaner.h"

namespace blockrand::importers::osm {
namespace {

using model::IssueCode;
using model::ObjectKind;
using model::ObjectState;
using model::OsmType;

/// A bounding box in units of 1e-7 degrees that grows.
struct Box {
  std::int64_t west = 1, south = 1, east = 0, north = 0;
  bool empty() const { return west > east; }
  void add(model::Location l) {
    if (empty()) {
      west = east = l.lon;
      south = north = l.lat;
      return;
    }
    west = std::min<std::int64_t>(west, l.lon);
    east = std::max<std::int64_t>(east, l.lon);
    south = std::min<std::int64_t>(south, l.lat);
    north = std::max<std::int64_t>(north, l.lat);
  }
};

class ExtractWriter {
 public:
  ExtractWriter(const RawData& data, const OsmFile& file, const ReadOptions& options, model::Extract& out)
      : data_(data), file_(file), out_(out), texts_(data.strings.size()) {
    if (options.bbox) {
      const auto unit = [](double degrees) {
        return static_cast<std::int64_t>(degrees * 1e7 + (degrees < 0 ? -0.5 : 0.5));
      };
      const auto clip = [&](const std::array<double, 4>& b) {
        clip_.push_back({unit(b[0]), unit(b[1]), unit(b[2]), unit(b[3])});
      };
      std::ranges::for_each(options.parts, clip);
      if (options.parts.empty()) clip(*options.bbox);
      placeless_ = options.placeless, touching_ = options.touching;
    }
  }

  void write_buildings(const Accounts& accounts) {
    std::vector<bool> kept(accounts.list.size(), true);
    if (!clip_.empty()) decide_clip(accounts, kept);
    out_.buildings.reserve(accounts.list.size());
    // Nearly everything read is written: growing by doubling would cost half as much again.
    out_.tags.reserve(data_.tags.size());
    out_.vertices.reserve(data_.refs.size());
    out_.vertex_nodes.reserve(data_.refs.size());
    for (std::size_t i = 0; i < accounts.list.size(); ++i)
      if (kept[i]) write_building(accounts, accounts.list[i]);
    const auto is_kept = [&](model::OsmId id) {
      const Account* a = accounts.find(id);
      return a != nullptr && kept[static_cast<std::size_t>(a - accounts.list.data())];
    };
    for (model::BuildingRelation relation : accounts.building_relations) {
      if (relation.outline.number != 0 && !is_kept(relation.outline)) relation.outline = {};
      std::erase_if(relation.parts, [&](model::OsmId id) { return !is_kept(id); });
      if (relation.outline.number != 0 || !relation.parts.empty())
        out_.building_relations.push_back(std::move(relation));
    }
    for (const model::ReportRow& row : accounts.notices) {
      const Account* a = accounts.find(row.object);
      if (is_kept(row.object) && a->state != ObjectState::duplicate) out_.report.rows.push_back(row);
    }
    out_.counts.old_style_multipolygons = accounts.old_style_multipolygons;
  }

  void write_features(const Accounts& accounts) {
    std::vector<model::ReportRow> notices;
    for_each_feature(data_, accounts, notices, [&](const PlannedFeature& f) {
      if (!clip_.empty() && !touches(f)) return;
      model::Feature feature;
      feature.id = f.id;
      feature.kinds = f.kinds;
      feature.area = f.area;
      feature.rings = write_rings(f.rings);
      feature.tags = write_tags(f.id, *f.raw, nullptr);
      out_.features.push_back(feature);
    });
    for (model::ReportRow& row : notices) {
      const auto found = std::lower_bound(out_.features.begin(), out_.features.end(), row.object,
                                          [](const model::Feature& f, model::OsmId id) { return f.id < id; });
      if (found != out_.features.end() && found->id == row.object) out_.report.rows.push_back(std::move(row));
    }
  }

  void write_counts() {
    auto& c = out_.counts;
    c.nodes = data_.node_count;
    c.ways = data_.way_count;
    c.relations = data_.relation_count;
    c.missing_nodes = data_.positions.count_missing();
    std::vector<std::int64_t> absent;
    for (const RawRelation& relation : data_.relations)
      for (const RawMember& m : data_.members_of(relation))
        if (m.type == OsmType::way && data_.way(m.ref) == nullptr) absent.push_back(m.ref);
    std::sort(absent.begin(), absent.end());
    c.missing_ways = static_cast<std::uint64_t>(std::unique(absent.begin(), absent.end()) - absent.begin());
    if (data_.newest > 0) out_.data_time = osmium::Timestamp(data_.newest).to_iso();
    std::sort(out_.report.rows.begin(), out_.report.rows.end());
  }

 private:
  void write_building(const Accounts& accounts, const Account& account) {
    count(account);
    model::MappedBuilding b;
    b.id = account.id;
    b.kind = account.kind;
    b.state = account.state;
    b.code = account.code;
    b.related = account.related;
    b.geometry_from = account.geometry_from;
    if (account.state == ObjectState::pending) {
      if (account.area >= 0) {
        const Area& area = accounts.areas[static_cast<std::size_t>(account.area)];
        b.rings = write_rings(area.rings);
        out_.counts.areas_with_holes += area.has_holes();
      } else {
        const Area own = assemble_way(data_, static_cast<const RawWay&>(*account.raw));
        b.rings = write_rings(own.rings);
        if (own.code != IssueCode::none) out_.report.add(b.id, own.code, own.detail);
      }
    } else if (account.state == ObjectState::reported) {
      const auto detail = accounts.details.find(account.id);
      out_.report.add(b.id, account.code,
                      detail == accounts.details.end() ? std::string() : clean_text(detail->second));
    }
    if (b.rings.count == 0)
      // What spans half the globe crosses 180 degrees: its middle is not there.
      if (const Box box = box_of(accounts, account); !box.empty() && box.east - box.west < 1'800'000'000)
        b.place = model::Location{static_cast<std::int32_t>((box.west + box.east) / 2),
                                  static_cast<std::int32_t>((box.south + box.north) / 2)};
    b.tags = write_tags(account.id, *account.raw, account.tags_also_from);
    b.edited = account.raw->timestamp;
    // `pairs_` holds the tags just written.
    b.attributes = read_attributes(b.id, b.kind, pairs_, out_.strings, out_.report);
    out_.buildings.push_back(b);
  }

  void count(const Account& account) {
    auto& c = out_.counts;
    const bool building = account.kind == ObjectKind::building;
    switch (account.id.type) {
      case OsmType::node:
        ++(building ? c.building_nodes : c.part_nodes);
        break;
      case OsmType::way:
        ++(building ? c.building_ways : c.part_ways);
        break;
      case OsmType::relation:
        ++(building ? c.building_relations : c.part_relations);
        break;
    }
  }

  model::Range write_rings(const std::vector<AreaRing>& rings) {
    model::Range range{static_cast<std::uint32_t>(out_.rings.size()), static_cast<std::uint32_t>(rings.size())};
    for (const AreaRing& ring : rings) {
      out_.rings.push_back(
          {{static_cast<std::uint32_t>(out_.vertices.size()), static_cast<std::uint32_t>(ring.vertices.size())},
           ring.inner});
      for (const Vertex& v : ring.vertices) {
        out_.vertices.push_back(v.location);
        out_.vertex_nodes.push_back(v.node);
      }
    }
    return range;
  }

  /// A string of the file as it is written, and whether that differs.
  struct Text {
    std::string_view clean;
    std::optional<base::StringId> id;
    bool known = false, dirty = false;
  };
  Text& text(base::StringId raw) {
    Text& t = texts_[raw];
    if (!t.known) {
      t.known = true;
      t.clean = data_.strings.view(raw);
      if (!is_clean_text(t.clean)) {
        cleaned_.push_back(clean_text(t.clean));
        t.clean = cleaned_.back();
        t.dirty = true;
      } else {
        t.dirty = file_.was_cleaned(t.clean);
      }
    }
    return t;
  }
  base::StringId intern(Text& t) {
    if (!t.id) t.id = out_.strings.intern(t.clean);
    return *t.id;
  }

  /// Tags sorted by key, those of `more` whose keys `raw` lacks among them.
  model::Range write_tags(model::OsmId id, const RawObject& raw, const RawObject* more) {
    sorted_.clear();
    for (const model::Tag& t : data_.tags_of(raw)) sorted_.emplace_back(&text(t.key), &text(t.value));
    if (more != nullptr) {
      const std::size_t own = sorted_.size();
      for (const model::Tag& t : data_.tags_of(*more)) {
        Text& key = text(t.key);
        if (std::none_of(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(own),
                         [&](const auto& k) { return k.first->clean == key.clean; }))
          sorted_.emplace_back(&key, &text(t.value));
      }
    }
    std::sort(sorted_.begin(), sorted_.end(), [](const auto& a, const auto& b) {
      return std::tie(a.first->clean, a.second->clean) < std::tie(b.first->clean, b.second->clean);
    });
    // OpenStreetMap has each key once; files from elsewhere, and keys that became equal by cleaning, may not.
    const auto again = std::unique(sorted_.begin(), sorted_.end(), [&](const auto& a, const auto& b) {
      if (a.first->clean != b.first->clean) return false;
      out_.report.add(id, IssueCode::duplicate_key, std::string(b.first->clean) + "=" + std::string(b.second->clean));
      return true;
    });
    sorted_.erase(again, sorted_.end());
    pairs_.clear();
    const model::Range range{static_cast<std::uint32_t>(out_.tags.size()), static_cast<std::uint32_t>(sorted_.size())};
    for (const auto& [key, value] : sorted_) {
      const base::StringId k = intern(*key);
      out_.tags.push_back({k, intern(*value)});
      pairs_.emplace_back(key->clean, value->clean);
      if (key->dirty || value->dirty)
        out_.report.add(id, IssueCode::text_cleaned, std::string(key->clean) + "=" + std::string(value->clean));
    }
    return range;
  }

  /// Which accounts lie in the clip boxes: those with a position by their own bounding box (its centre, or all of it), those that
  /// another object stands for with that object as well: they are told where they lie, whatever stands for them.
  void decide_clip(const Accounts& accounts, std::vector<bool>& kept) const {
    const auto holds = [&](const Box& box) { return touching_ ? touches(box) : holds_centre(box); };
    const auto is_inside = [&](const Account& account) {
      const Box box = box_of(accounts, account);
      return box.empty() ? placeless_ : holds(box);
    };
    for (std::size_t i = 0; i < accounts.list.size(); ++i) {
      const Account& account = accounts.list[i];
      const bool follows = account.state == ObjectState::duplicate || account.state == ObjectState::represented;
      const Account* master = follows ? accounts.find(account.related) : nullptr;
      const Box own = master != nullptr ? box_of(accounts, account) : Box();
      kept[i] = is_inside(master != nullptr ? *master : account) || (!own.empty() && holds(own));
    }
  }

  bool holds_centre(const Box& box) const {
    // Doubled, so that the centre is exact.
    const std::int64_t x = box.west + box.east, y = box.south + box.north;
    return std::ranges::any_of(clip_, [&](const Box& clip) {
      return x >= 2 * clip.west && x <= 2 * clip.east && y >= 2 * clip.south && y <= 2 * clip.north;
    });
  }
  bool touches(const Box& box) const {
    return std::ranges::any_of(clip_, [&](const Box& clip) {
      return box.west <= clip.east && box.east >= clip.west && box.south <= clip.north && box.north >= clip.south;
    });
  }

  Box box_of(const Accounts& accounts, const Account& account) const {
    Box box;
    const auto add_way = [&](const RawWay& way) {
      for (const std::int64_t ref : data_.refs_of(way))
        if (const model::Location l = data_.positions.find(ref); is_known(l)) box.add(l);
    };
    if (account.area >= 0) {
      for (const AreaRing& ring : accounts.areas[static_cast<std::size_t>(account.area)].rings)
        for (const Vertex& v : ring.vertices) box.add(v.location);
    } else if (account.id.type == OsmType::way) {
      add_way(static_cast<const RawWay&>(*account.raw));
    } else if (account.id.type == OsmType::node) {
      if (const auto l = static_cast<const RawNode&>(*account.raw).location; is_known(l)) box.add(l);
    } else {
      for (const RawMember& m : data_.members_of(static_cast<const RawRelation&>(*account.raw)))
        if (const RawWay* way = m.type == OsmType::way ? data_.way(m.ref) : nullptr) add_way(*way);
    }
    return box;
  }

  bool touches(const PlannedFeature& f) const {
    Box box;
    for (const AreaRing& ring : f.rings)
      for (const Vertex& v : ring.vertices) box.add(v.location);
    return !box.empty() && touches(box);
  }

  const RawData& data_;
  const OsmFile& file_;
  model::Extract& out_;
  std::vector<Box> clip_;  ///< empty: everything is kept
  bool placeless_ = false, touching_ = false;
  std::vector<Text> texts_;  ///< by raw string id
  std::deque<std::string> cleaned_;
  std::vector<std::pair<Text*, Text*>> sorted_;
  std::vector<std::pair<std::string_view, std::string_view>> pairs_;
};

}  // namespace

model::Extract read_extract(const std::string& path, const ReadOptions& options) {
  OsmFile file(path);
  return read_file(file, path, options);
}

model::Extract read_file(OsmFile& file, const std::string& path, const ReadOptions& options) {
  RawData data;
  try {
    data = read_raw(file, options.surroundings, options.progress);
  } catch (const NulInText&) {
    file.clean_strings();
    try {
      data = read_raw(file, options.surroundings, options.progress);
    } catch (const NulInText&) {
      throw base::InputError(path, "", "tags cannot be read", "The file is damaged: fetch or write it again");
    }
  }
  if (options.progress) options.progress("assembling areas", 0);
  model::Extract out;
  out.file = path;
  const Accounts accounts = open_accounts(data);
  ExtractWriter writer(data, file, options, out);
  writer.write_buildings(accounts);
  writer.write_features(accounts);
  writer.write_counts();
  if (options.progress) options.progress("assembling areas", 1);
  return out;
}

}  // namespace blockrand::importers::osm
