// The lists of issues, and the map that they point to.
#include <algorithm>

#include "pipeline/outputs/report/houses.h"
#include "pipeline/outputs/report/html_text.h"
#include "pipeline/outputs/report/report_sections.h"

namespace blockrand::outputs {
namespace {

using base::with_thousands;
using model::IssueClass;

/// Finds the building that an object is or belongs to.
class Finder {
 public:
  explicit Finder(const MapFootprints& footprints) : parts_(footprints.parts) {
    for (std::uint32_t b = 0; b < footprints.buildings.size(); ++b)
      buildings_.emplace_back(footprints.buildings[b].osm, b);
    std::sort(buildings_.begin(), buildings_.end());
    std::sort(parts_.begin(), parts_.end());
  }
  std::uint32_t operator()(model::OsmId id) const {
    for (const auto* list : {&buildings_, &parts_}) {
      const auto found = std::lower_bound(list->begin(), list->end(), std::pair(id, std::uint32_t{0}));
      if (found != list->end() && found->first == id) return found->second;
    }
    return model::kNoIndex;
  }

 private:
  std::vector<std::pair<model::OsmId, std::uint32_t>> buildings_, parts_;
};

/// Stages name the body in the detail; where that is the object itself, the link says so already.
std::string_view without_id(const ListedRow& row) {
  const std::string prefix = row.object.text() + ": ";
  return row.detail.rfind(prefix, 0) == 0 ? std::string_view(row.detail).substr(prefix.size())
                                          : std::string_view(row.detail);
}

std::string limit(std::uint64_t count, std::size_t listed) {
  return count <= listed ? std::string() : with_thousands(listed);
}

}  // namespace

Issues collect_issues(const MapFootprints& footprints, const ReportFacts& facts, const ReportOptions& options) {
  Issues out;
  const Finder find(footprints);
  out.of_building.assign(footprints.buildings.size(), 0);
  for (std::size_t b = 0; b < footprints.buildings.size(); ++b)
    if (!footprints.buildings[b].built) out.of_building[b] = 3;
  std::vector<CodeRows> codes(model::kIssueCodeCount);
  const auto add = [&](model::OsmId object, model::IssueCode code, const std::string& detail, std::uint32_t building) {
    CodeRows& list = codes[static_cast<std::size_t>(code)];
    list.code = code;
    if (++list.count > options.listed_objects) return;
    list.rows.push_back({object, detail, building});
    if (building != model::kNoIndex) out.listed.push_back(building);
  };
  // Details that stages noted about objects that end as reported stand with the object, as in report.json.
  std::map<std::pair<model::OsmId, model::IssueCode>, const std::string*> details;
  for (const model::ReportRow& row : facts.rows) {
    const IssueClass klass = info(row.code).issue_class;
    if (klass == IssueClass::reported) {
      details.emplace(std::pair(row.object, row.code), &row.detail);
      continue;
    }
    const std::uint32_t building = find(row.object);
    if (building != model::kNoIndex) {
      std::uint8_t& worst = out.of_building[building];
      worst = std::max<std::uint8_t>(worst, klass == IssueClass::fallback ? 2 : 1);
    }
    add(row.object, row.code, row.detail, building);
  }
  for (const ReportedObject& object : facts.objects) {
    if (object.state != model::ObjectState::reported) continue;
    const auto found = details.find({object.id, object.code});
    add(object.id, object.code, found == details.end() ? std::string() : *found->second, find(object.id));
  }
  for (CodeRows& list : codes)
    if (list.count > 0) out.codes.push_back(std::move(list));
  std::sort(out.listed.begin(), out.listed.end());
  out.listed.erase(std::unique(out.listed.begin(), out.listed.end()), out.listed.end());
  return out;
}

Values issue_values(const MapFootprints& footprints, const Issues& issues, const ReportMap& map,
                    const ReportFacts& facts, const ReportOptions& options) {
  Values v;
  struct Group {
    IssueClass klass;
    std::string_view title, none;
  };
  constexpr Group kGroups[] = {
      {IssueClass::reported, "Not modelled", "Every mapped object is modelled or represented."},
      {IssueClass::fallback, "Built simpler than asked", "Everything was built as asked."},
      {IssueClass::notice, "Mended, ignored or unreadable", "The data had nothing to mend."}};
  for (const Group& group : kGroups) {
    std::uint64_t all = 0;
    Values g;
    g.set("title", group.title).set("none", group.none).set("codes", Values::List());
    for (const CodeRows& list : issues.codes) {
      if (info(list.code).issue_class != group.klass) continue;
      all += list.count;
      Values code;
      code.set("code", info(list.code).text).set("count", with_thousands(list.count));
      code.set("meaning", info(list.code).meaning).set("listed", limit(list.count, options.listed_objects));
      Values::List rows;
      for (const ListedRow& row : list.rows) {
        const bool marked = row.building != model::kNoIndex && std::ranges::binary_search(map.marks, row.building);
        rows.emplace_back();
        rows.back().set("link", osm_link(row.object)).set("id", row.object.text()).set("detail", without_id(row));
        rows.back().set("map", marked ? footprints.buildings[row.building].osm.text() : std::string());
      }
      code.set("rows", std::move(rows));
      g.add("codes", std::move(code));
    }
    g.set("count", with_thousands(all));
    v.add("groups", std::move(g));
  }
  // Objects that another one stands for are no issue, but nothing mapped goes unmentioned.
  struct Others {
    model::ObjectState state;
    std::string_view id, text;
  };
  constexpr Others kOthers[] = {
      {model::ObjectState::represented, "represented", "Represented by its parts: it has no body of its own."},
      {model::ObjectState::duplicate, "duplicate", "Mapped twice: the other object is modelled."}};
  Values represented;
  std::uint64_t all = 0;
  for (const Others& others : kOthers) {
    std::uint64_t count = 0;
    Values::List rows;
    for (const ReportedObject& object : facts.objects) {
      if (object.state != others.state || ++count > options.listed_objects) continue;
      rows.emplace_back();
      rows.back().set("id", object.id.text()).set("link", osm_link(object.id));
      rows.back().set("by", object.related.text()).set("by_link", osm_link(object.related));
    }
    all += count;
    if (count == 0) continue;
    Values state;
    state.set("state", others.id).set("count", with_thousands(count)).set("meaning", others.text);
    state.set("rows", std::move(rows)).set("listed", limit(count, options.listed_objects));
    represented.add("states", std::move(state));
  }
  represented.set("count", with_thousands(facts.represented + facts.duplicates));
  if (all > 0)
    v.add("others", std::move(represented));
  else
    v.set("others", false);
  return v;
}

std::string_view class_name(MapTheme theme, std::size_t k) {
  constexpr std::string_view kStoreys[kStoreyClasses] = {"not built", "1 storey", "2",      "3",          "4",
                                                         "5",         "6",        "7 to 9", "10 and more"};
  constexpr std::string_view kRoofs[kRoofClasses] = {
      "not built", "flat", "gabled", "hipped, pyramidal", "mansard, gambrel", "shed", "round, dome, spire", "other"};
  constexpr std::string_view kIssues[kIssueClasses] = {"as asked", "mended or noticed", "simpler than asked",
                                                       "not built"};
  switch (theme) {
    case MapTheme::style:
      return k == 0 ? "not classified" : style_label(static_cast<std::uint8_t>(k - 1));
    case MapTheme::era:
      return k == 0 ? "not classified" : era_label(static_cast<std::uint8_t>(k - 1));
    case MapTheme::storeys:
      return kStoreys[k];
    case MapTheme::roof:
      return kRoofs[k];
    case MapTheme::storeys_source:
    case MapTheme::height_source:
    case MapTheme::roof_source:
      return k == 0 ? "not built" : model::name(static_cast<model::Source>(k - 1));
    case MapTheme::issue:
      return kIssues[k];
  }
  return {};
}

Values map_values(const MapFootprints& footprints, const ReportMap& map, const ReportFacts& facts, bool styles) {
  Values v;
  if (!map.drawn) return v.set("frame", false);
  Values f;
  constexpr std::string_view kThemes[kMapThemes] = {
      "Style", "Era", "Storeys", "Roofs", "Source of storeys", "Source of heights", "Source of roofs", "Issues"};
  for (std::size_t t = 0; t < kMapThemes; ++t) {
    const auto theme = static_cast<MapTheme>(t);
    if (!styles && (theme == MapTheme::style || theme == MapTheme::era)) continue;
    Values entry;
    entry.set("letter", std::string(1, kThemeLetter[t])).set("name", kThemes[t]);
    entry.set("checked", theme == (styles ? MapTheme::style : MapTheme::storeys));
    entry.set("classes", Values::List());
    for (std::size_t k = 0; k < map.counts[t].size(); ++k)
      if (const std::uint64_t n = map.counts[t][k]; n > 0)
        entry.add(
            "classes",
            Values().set("class", std::to_string(k)).set("text", class_name(theme, k)).set("count", with_thousands(n)));
    f.add("themes", std::move(entry));
  }
  f.set("ratio", map.ratio).set("width", std::to_string(map.width)).set("height", std::to_string(map.height));
  f.set("metres", std::to_string(map.metres)).set("far", map.far).set("paths", map.paths);
  f.set("bar", map.bar_share).set("bar_length", map.bar_length);
  f.set("blocks", Values::List()).set("marks", Values::List());
  for (const auto& [number, d] : map.blocks)
    f.add("blocks", Values().set("number", std::to_string(number)).set("d", d));
  Values::List marks;
  for (const std::uint32_t b : map.marks) {
    marks.emplace_back();
    marks.back().set("id", footprints.buildings[b].osm.text()).set("radius", std::to_string(map.radius));
    marks.back().set("x", std::to_string(map.places[b]->x)).set("y", std::to_string(map.places[b]->y));
  }
  f.set("marks", std::move(marks));
  f.set("note", map.note).set("attribution", facts.attribution);
  const auto buildings = [](std::uint64_t n, std::string_view one, std::string_view many) {
    return n == 0 ? std::string() : with_thousands(n) + std::string(n == 1 ? one : many);
  };
  f.set("outside", buildings(map.outside, " building lies", " buildings lie"));
  f.set("without_area", buildings(map.without_area, " building has", " buildings have"));
  return v.add("frame", std::move(f));
}

}  // namespace blockrand::outputs
