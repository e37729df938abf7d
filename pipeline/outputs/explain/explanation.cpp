#include "pipeline/outputs/explain/explanation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/outputs/explain/detail_text.h"
#include "pipeline/outputs/explain/json_text.h"
#include "pipeline/outputs/explain/places.h"
#include "pipeline/outputs/explain/situation_text.h"
#include "pipeline/outputs/explain/style_text.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

using model::Building;
using model::BuildingPart;
using model::ObjectState;
using model::Region;
using model::ReportRow;
using model::Sourced;

std::string_view name(model::IssueClass issue_class) {
  constexpr std::string_view names[] = {"reported", "fallback", "notice"};
  return names[static_cast<int>(issue_class)];
}

constexpr std::int64_t kTurn = 3'600'000'000;  // 360 degrees in OSM's 1e-7

class Writer {
 public:
  Writer(const Region& region, const ExplainOptions& options)
      : region_(region), options_(options), tags_(region.extract) {
    rows_.reserve(region.report.rows.size());
    for (const ReportRow& row : region.report.rows) rows_.push_back(&row);
    std::stable_sort(rows_.begin(), rows_.end(),
                     [](const ReportRow* a, const ReportRow* b) { return a->object < b->object; });
  }

  void line(const Building& building, Explanations& out) {
    text_ = &out.lines;
    json_ = JsonText(out.lines);
    const FinalState final_state = options_.final_state(building.mapped_index);
    json_.open('{');
    json_.string("id", building.id());
    json_.string("tile", options_.tile);
    json_.string("state", model::name(final_state.state));
    if (final_state.state == ObjectState::reported) {
      json_.string("code", model::info(final_state.code).text);
      json_.string("meaning", model::info(final_state.code).meaning);
    }
    int lod = -1;
    for (const BuildingPart& part : building.parts)
      if (part.lod >= 0) lod = lod < 0 ? part.lod : std::min(lod, part.lod);
    if (lod >= 0) json_.number("lod", lod);
    identity(building);
    const Middle middle = outline(building.mapped_index);
    out.places.emplace_back(building.osm, place_line({.id = building.id(),
                                                      .tile = options_.tile,
                                                      .lon = middle.lon,
                                                      .lat = middle.lat,
                                                      .top = top_of(building),
                                                      .addresses = addresses_of(region_, tags_, building),
                                                      .name = std::string(tags_.name(building.tags))}));
    stages(building, final_state);
    append_style(json_, building);
    attributes(building.attributes);
    bodies(building);
    notes(building);
    json_.key("files");
    json_.open('[');
    if (!building.parts.empty())
      for (const std::string& file : options_.files) json_.element(file);
    json_.close(']');
    json_.close('}');
    *text_ += '\n';

    out.objects.emplace_back(building.osm, building.osm);
    std::set<model::OsmId> parts;  // a part may be built in pieces
    for (const BuildingPart& part : building.parts)
      if (part.osm != building.osm && parts.insert(part.osm).second) out.objects.emplace_back(part.osm, building.osm);
  }

 private:
  // ---- who it is
  void identity(const Building& building) {
    if (const auto name = tags_.name(building.tags); !name.empty()) json_.string("name", name);
    if (const std::string address = tags_.address(building.tags).line(); !address.empty())
      json_.string("address", address);
    if (building.replaced) {
      json_.string("origin", "replaced");
      json_.string("replaced_by", model::text(*building.replaced));
    }
    json_.key("tags");
    if (tags_.extract())
      append_tags_json(*text_, *tags_.extract(), building.tags);
    else
      *text_ += "{}";
  }

  struct Middle {
    double lon = 0, lat = 0;  // degrees
  };
  Middle outline(std::uint32_t mapped_index) {
    if (!region_.extract || mapped_index == model::kNoIndex) return {};
    const model::Extract& extract = *region_.extract;
    const auto rings = extract.rings_of(extract.buildings[mapped_index].rings);
    if (rings.empty()) return {};
    // The vertices of an object's rings follow each other in the extract or not: go by ring.
    std::vector<std::int64_t> nodes, lon, lat;
    std::int64_t west = 0, east = 0, south = 0, north = 0;
    for (const model::MappedRing& ring : rings) {
      const auto ids = extract.nodes_of(ring);
      nodes.insert(nodes.end(), ids.begin(), ids.end());
      for (const model::Location v : extract.mapped_vertices_of(ring)) {
        if (lon.empty()) west = east = v.lon, south = north = v.lat;
        // Around the first vertex: an outline may cross 180 degrees.
        std::int64_t x = v.lon;
        if (!lon.empty() && x - lon.front() > kTurn / 2) x -= kTurn;
        if (!lon.empty() && lon.front() - x > kTurn / 2) x += kTurn;
        west = std::min(west, x), east = std::max(east, x);
        south = std::min<std::int64_t>(south, v.lat), north = std::max<std::int64_t>(north, v.lat);
        lon.push_back(v.lon);
        lat.push_back(v.lat);
      }
    }
    std::int64_t middle = west + (east - west) / 2;
    if (middle > kTurn / 2) middle -= kTurn;
    if (middle < -kTurn / 2) middle += kTurn;
    json_.key("place");
    json_.open('{');
    const Middle place{static_cast<double>(middle) / 1e7, static_cast<double>(south + (north - south) / 2) / 1e7};
    json_.number("lon", place.lon);
    json_.number("lat", place.lat);
    json_.close('}');
    json_.key("outline");
    json_.open('{');
    json_.integers("nodes", nodes.size(), [&](std::size_t i) { return nodes[i]; });
    json_.integers("lon", lon.size(), [&](std::size_t i) { return lon[i]; });
    json_.integers("lat", lat.size(), [&](std::size_t i) { return lat[i]; });
    json_.integers("rings", rings.size(),
                   [&](std::size_t i) { return static_cast<std::int64_t>(rings[i].vertices.count); });
    json_.close('}');
    return place;
  }

  // ---- what each stage did
  void stage(std::string_view name, std::string_view text) {
    json_.open('{');
    json_.string("stage", name);
    json_.string("text", text);
    json_.close('}');
  }

  /// Notices of one building and its parts with a code of `codes`, as "meaning (detail)".
  std::string said(const Building& building, std::initializer_list<model::IssueCode> codes) {
    std::string text;
    for_each_row(building, [&](const ReportRow& row) {
      if (std::find(codes.begin(), codes.end(), row.code) == codes.end()) return;
      std::string_view meaning = model::info(row.code).meaning;
      if (meaning.ends_with('.')) meaning.remove_suffix(1);
      text += (text.empty() ? "" : "; ") + std::string(meaning);
      if (!row.detail.empty()) text += " (" + row.detail + ")";
      if (row.object != building.osm) text += " in part " + row.object.text();
    });
    return text;
  }

  void stages(const Building& building, const FinalState& final_state) {
    json_.key("stages");
    json_.open('[');
    stage("read", read_text(building));
    const std::optional<SeenOutline> seen = options_.seen ? options_.seen(building.osm) : std::nullopt;
    if (seen) stage("image", imagery_text(*seen));
    stage("repair", repair_text(building));
    if (!building.parts.empty()) {
      stage("context", context_text(building));
      stage("resolve", resolve_text(building));
      if (const std::string text = assign_text(building); !text.empty()) stage("assign", text);
    }
    stage("build", build_text(building, final_state));
    if (const std::string text = facade_text(building); !text.empty()) stage("facades", text);
    if (!building.parts.empty()) stage("check", check_text(building));
    json_.close(']');
    if (seen) append_imagery(json_, *seen);
    append_repair(json_, building);
    append_situation(json_, building);
    append_edges(json_, building, region_.extract);
  }

  std::string mapped_text(const Building& building) const {
    if (!region_.extract || building.mapped_index == model::kNoIndex) return "made by the program";
    const model::Extract& extract = *region_.extract;
    const model::MappedBuilding& mapped = extract.buildings[building.mapped_index];
    const auto rings = extract.rings_of(mapped.rings);
    std::size_t points = 0, holes = 0;
    for (const model::MappedRing& ring : rings) {
      points += ring.vertices.count;
      holes += ring.inner;
    }
    std::string text = fmt::format("{} in OpenStreetMap with {} and {}",
                                   mapped.id.type == model::OsmType::way        ? "a closed way"
                                   : mapped.id.type == model::OsmType::relation ? "a relation"
                                                                                : "a node",
                                   counted(building.tags.count, "tag"), counted(points, "point"));
    if (holes > 0) text += ", " + counted(holes, "courtyard");
    if (mapped.geometry_from != mapped.id && mapped.geometry_from.number != 0)
      text += "; its outline comes from " + mapped.geometry_from.text();
    if (building.has_mapped_parts) {
      std::size_t parts = 0;
      for (const BuildingPart& part : building.parts) parts += !part.rest;
      text += "; mapped in " + counted(parts, "part");
    }
    return text;
  }

  std::string read_text(const Building& building) {
    const std::string text = mapped_text(building);
    const std::string noted = said(building, {model::IssueCode::value_unreadable, model::IssueCode::value_clamped,
                                              model::IssueCode::values_conflict, model::IssueCode::members_missing,
                                              model::IssueCode::relation_repaired,
                                              model::IssueCode::old_style_multipolygon, model::IssueCode::text_cleaned,
                                              model::IssueCode::part_without_outline, model::IssueCode::antimeridian});
    return noted.empty() ? text : text + ". " + noted;
  }

  std::string repair_text(const Building& building) {
    using model::IssueCode;
    std::vector<std::string> pieces;
    const std::string mended =
        said(building,
             {IssueCode::duplicate_points, IssueCode::spike_removed, IssueCode::ring_repaired, IssueCode::split_outline,
              IssueCode::touching_rings, IssueCode::sliver_dropped, IssueCode::collinear_points,
              IssueCode::shared_wall_conflict, IssueCode::overlap_kept, IssueCode::nested_building,
              IssueCode::repair_bounded, IssueCode::parts_outside, IssueCode::parts_overlap, IssueCode::outline_made,
              IssueCode::parts_incomplete, IssueCode::reach_cut});
    const std::string moved = moved_text(building);
    if (!mended.empty()) pieces.push_back(mended);
    if (!moved.empty()) pieces.push_back(moved);
    if (pieces.empty()) pieces.push_back("nothing to mend");
    double area = 0;
    std::size_t points = 0;
    const auto add = [&](const model::Polygon& p) {
      area += geometry::area(p);
      points += p.outer.size();
      for (const model::Ring& hole : p.holes) points += hole.size();
    };
    for (const model::Polygon& p : building.outline) add(p);
    if (points > 0) pieces.push_back(fmt::format("the footprint has {} points and {:.1f} m2", points, area));
    return fmt::format("{}", fmt::join(pieces, "; "));
  }

  std::string context_text(const Building& building) {
    const bool looked_at = building.situation.position != model::BuildingPosition::unknown ||
                           std::any_of(building.edges.begin(), building.edges.end(),
                                       [](const model::WallSegment& e) { return e.end > e.start; });
    return looked_at ? situation_text(building, options_.courtyard) : "its surroundings were not looked at";
  }

  std::string resolve_text(const Building& building) {
    int tagged = 0, followed = 0, around = 0, assumed = 0;
    const auto count = [&](std::string_view, std::string_view, const auto& sourced) {
      switch (sourced.source) {
        case model::Source::override_:
        case model::Source::tag:
          ++tagged;
          break;
        case model::Source::preset:
        case model::Source::default_:
          ++assumed;
          break;
        case model::Source::neighbours:
        case model::Source::block:
        case model::Source::cell:
        case model::Source::district:
        case model::Source::region:
          ++around;
          break;
        case model::Source::implied:
        case model::Source::part:
        case model::Source::imagery:
        case model::Source::terrain:
        case model::Source::geometry:
          ++followed;
      }
    };
    model::for_each_attribute(building.attributes, count, [](std::string_view, std::string_view) {});
    return fmt::format(
        "{} values: {} tagged, {} following from other values, parts or the plan, {} from the surroundings, {} assumed",
        tagged + followed + around + assumed, tagged, followed, around, assumed);
  }

  /// The preset with its parameters, and what is ordered for single storeys, edges and bays.
  std::string assign_text(const Building& building) const {
    std::string text;
    if (const std::string& preset = building.attributes.preset.value; !preset.empty()) text = "preset " + preset;
    for (const auto& [key, value] : building.preset_parameters)
      text += fmt::format("{}{}={}", text.empty() ? "" : ", ", key, value);
    for (const model::DetailOverride& d : building.detail_overrides) {
      text += fmt::format("{}{}{} {} ordered", text.empty() ? "" : "; ", d.body == building.id() ? "" : d.body + " ",
                          model::name(d.kind), d.name);
      for (const auto& [key, value] : d.values) text += fmt::format(" {}={}", key, value);
      text += " (" + d.from + ")";
    }
    return text;
  }

  std::string build_text(const Building& building, const FinalState& final_state) {
    if (building.parts.empty()) return fmt::format("nothing was built: {}", model::info(final_state.code).meaning);
    if (building.replaced) return "the model " + model::text(*building.replaced);
    if (building.parts.size() == 1) return body_text(building.parts.front());
    // Bodies that became the same are named together, in the order of the first of them.
    std::vector<std::pair<std::string, std::vector<std::string>>> groups;
    for (const BuildingPart& part : building.parts) {
      const std::string what = body_text(part);
      const auto known = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == what; });
      if (known == groups.end())
        groups.push_back({what, {part.id}});
      else
        known->second.push_back(part.id);
    }
    constexpr std::size_t kMostGroups = 12;  // more is no help to a reader; "bodies" has them all
    std::string text;
    for (std::size_t i = 0; i < std::min(groups.size(), kMostGroups); ++i)
      text += (i ? "; " : "") + listed(groups[i].second, 3) + ": " + groups[i].first;
    if (groups.size() > kMostGroups) text += fmt::format("; and {} more kinds", groups.size() - kMostGroups);
    return text;
  }

  std::string body_text(const BuildingPart& part) const {
    if (part.lod < 0) return "no solid could be made";
    std::string text;
    if (part.lod == 0) text = "a footprint on the ground";
    if (part.lod == 1) text = "a block without a roof";
    if (part.lod >= 2)
      text = part.canopy ? "a canopy"
                         : fmt::format("walls to {:.1f} m under a {} roof",
                                       part.attributes.height.value - part.attributes.roof_height.value,
                                       model::name(part.built_roof));
    if (options_.lod >= 2 && part.built_roof != part.attributes.roof_shape.value && !part.canopy)
      text += fmt::format(" where {} was wanted", model::name(part.attributes.roof_shape.value));
    for (const model::IssueCode code : part.fallbacks) {
      std::string_view meaning = model::info(code).meaning;
      if (meaning.ends_with('.')) meaning.remove_suffix(1);
      text += fmt::format(" ({}: {})", model::info(code).text, meaning);
    }
    return text;
  }

  /// Which rules made the fronts, what stands in and on them, and what was left out. Empty below LoD3.
  std::string facade_text(const Building& building) {
    if (options_.lod < 3 || building.parts.empty()) return {};
    if (building.replaced) return "a model replaces the building: no rules run";
    const std::string& preset = building.attributes.preset.value;
    const std::string file = options_.rule_file ? options_.rule_file(preset) : std::string();
    if (file.empty())
      return preset.empty() ? "no preset, so no rules: walls stay plain"
                            : fmt::format("preset {} has no rule file: walls stay plain", preset);
    DetailCounts sum;
    bool any = false;
    for (const BuildingPart& part : building.parts) {
      if (part.lod < 3) continue;
      any = true;
      add_detail(region_, part.lod3, sum);
    }
    std::string text = fmt::format("rule file {} of preset {}", file, preset);
    for (const BuildingPart& part : building.parts)
      if (const std::string& own = part.attributes.preset.value; !own.empty() && own != preset)
        text += fmt::format(", {} of preset {} for {}", options_.rule_file(own), own, part.id);
    text += any ? ": " + detail_text(sum) : ": no body has facades";
    const std::string noted = said(
        building, {model::IssueCode::opening_left_out, model::IssueCode::facade_failed, model::IssueCode::grammar_error,
                   model::IssueCode::leaf_dropped, model::IssueCode::roof_element_left_out});
    return noted.empty() ? text : text + ". " + noted;
  }

  std::string check_text(const Building& building) const {
    std::size_t solids = 0, faces = 0, surfaces = 0;
    for (const BuildingPart& part : building.parts)
      for (const model::Solid* solid : {&part.lod1, &part.lod2, &part.lod3.solid}) {
        if (!solid->closed) {
          surfaces += solid->faces.size();
          continue;
        }
        solids += !solid->empty();
        faces += solid->faces.size();
      }
    const std::string open = surfaces == 0 ? "" : fmt::format("{} surfaces that need not bound anything", surfaces);
    if (solids == 0) return open.empty() ? "there is no solid to check" : open;
    return fmt::format("{} with {} faces: closed, outward, without self-intersections{}{}", counted(solids, "solid"),
                       faces, open.empty() ? "" : "; ", open);
  }

  // ---- values
  void value(double v) { append_number(*text_, std::isfinite(v) ? v : 0.0); }
  void value(const std::string& v) { append_json(*text_, v); }
  void value(model::Colour v) { append_json(*text_, model::text(v)); }
  void value(model::RoofShape v) { append_json(*text_, model::name(v)); }
  void value(model::RoofOrientation v) { append_json(*text_, v == model::RoofOrientation::along ? "along" : "across"); }

  void attributes(const model::Attributes& a) {
    json_.key("attributes");
    json_.open('[');
    model::for_each_attribute(
        a,
        [&](std::string_view attribute, std::string_view unit, const auto& sourced) {
          json_.open('{');
          json_.string("name", attribute);
          json_.key("value");
          value(sourced.value);
          if (!unit.empty()) json_.string("unit", unit);
          json_.string("source", model::name(sourced.source));
          json_.key("confidence");
          append_number(*text_, sourced.confidence);
          const model::Evidence& evidence = region_.evidence[sourced.evidence];
          if (!evidence.text.empty()) json_.string("why", evidence.text);
          if (!evidence.other_candidates.empty()) {
            json_.key("lost");
            json_.open('[');
            for (const model::Candidate& c : evidence.other_candidates) {
              json_.open('{');
              json_.string("value", c.value);
              json_.string("source", model::name(c.source));
              json_.key("confidence");
              append_number(*text_, c.confidence);
              if (!c.text.empty()) json_.string("why", c.text);
              json_.close('}');
            }
            json_.close(']');
          }
          json_.close('}');
        },
        [](std::string_view, std::string_view) {});
    json_.close(']');
  }

  void bodies(const Building& building) {
    json_.key("bodies");
    json_.open('[');
    for (const BuildingPart& part : building.parts) {
      json_.open('{');
      json_.string("id", part.id);
      if (part.osm != building.osm) {
        json_.key("tags");
        if (tags_.extract())
          append_tags_json(*text_, *tags_.extract(), part.tags);
        else
          *text_ += "{}";
      }
      json_.number("lod", part.lod);
      json_.string("asked_roof", model::name(part.attributes.roof_shape.value));
      json_.string("built_roof", model::name(part.built_roof));
      json_.key("fallbacks");
      json_.open('[');
      for (const model::IssueCode code : part.fallbacks) json_.element(model::info(code).text);
      json_.close(']');
      if (part.lod >= 3) append_detail(json_, region_, part.lod3);
      // A single body has the building's attributes: said once.
      if (building.has_mapped_parts || building.parts.size() > 1) attributes(part.attributes);
      json_.close('}');
    }
    json_.close(']');
  }

  template <class Visit>
  void for_each_row(const Building& building, Visit&& visit) {
    const auto of_object = [&](model::OsmId id) {
      auto early = std::lower_bound(options_.earlier.begin(), options_.earlier.end(), id,
                                    [](const ReportRow& row, model::OsmId o) { return row.object < o; });
      for (; early != options_.earlier.end() && early->object == id; ++early) visit(*early);
      auto late = std::lower_bound(rows_.begin(), rows_.end(), id,
                                   [](const ReportRow* row, model::OsmId o) { return row->object < o; });
      for (; late != rows_.end() && (*late)->object == id; ++late) visit(**late);
    };
    of_object(building.osm);
    std::vector<model::OsmId> parts;
    for (const BuildingPart& part : building.parts)
      if (part.osm != building.osm && std::find(parts.begin(), parts.end(), part.osm) == parts.end())
        parts.push_back(part.osm);
    for (const model::OsmId id : parts) of_object(id);
  }

  void notes(const Building& building) {
    json_.key("notes");
    json_.open('[');
    for_each_row(building, [&](const ReportRow& row) {
      const model::IssueInfo& about = model::info(row.code);
      json_.open('{');
      if (row.object != building.osm) json_.string("object", row.object.text());
      json_.string("code", about.text);
      json_.string("class", name(about.issue_class));
      json_.string("meaning", about.meaning);
      if (!row.detail.empty()) json_.string("detail", row.detail);
      json_.close('}');
    });
    json_.close(']');
  }

  const Region& region_;
  const ExplainOptions& options_;
  TagReader tags_;
  std::vector<const ReportRow*> rows_;
  std::string* text_ = nullptr;  // the lines so far
  JsonText json_;                // writes to the same
};

}  // namespace

Explanations explain(const Region& region, const ExplainOptions& options, const Sink& take) {
  Explanations out;
  Writer writer(region, options);
  const auto hand_over = [&] {
    take(out.lines);
    out.lines.clear();
  };
  for (const Building& building : region.buildings) {
    if (!building.owned) continue;
    writer.line(building, out);
    if (take && out.lines.size() >= kExplainedPiece) hand_over();
  }
  if (take && !out.lines.empty()) hand_over();
  return out;
}

std::string index_line(model::OsmId object, std::string_view tile, model::OsmId building) {
  return fmt::format("{} {} {}\n", object.text(), tile, building.text());
}

}  // namespace blockrand::outputs
