// The lists of issues, and the map that they point to.
#include <algorithm>

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

std::string limit_note(std::uint64_t count, std::size_t listed) {
  if (count <= listed) return {};
  return "<p class=\"small soft\">The first " + with_thousands(listed) + " of " + with_thousands(count) +
         " are listed; all are in <a href=\"report.json\">report.json</a>.</p>\n";
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

std::string issue_section(const MapFootprints& footprints, const Issues& issues,
                          const std::vector<std::uint32_t>& marks, const ReportFacts& facts,
                          const ReportOptions& options) {
  std::string out =
      "<section id=\"issues\">\n<h2>Fallbacks and issues</h2>\n<p class=\"issues-lead\">One bad building never stops a "
      "build. What could not be built as "
      "mapped was built simpler, what was mended is noted, and what has no body is listed with the reason. Ids lead to "
      "OpenStreetMap, where the data can be corrected.</p>\n";
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
    for (const CodeRows& list : issues.codes)
      if (info(list.code).issue_class == group.klass) all += list.count;
    out += "<h3>" + std::string(group.title) + " <span class=\"soft\">" + with_thousands(all) + "</span></h3>\n";
    if (all == 0) out += "<p>" + std::string(group.none) + "</p>\n";
    for (const CodeRows& list : issues.codes) {
      if (info(list.code).issue_class != group.klass) continue;
      const std::string code(info(list.code).text);
      out += "<details class=\"code\" id=\"code-" + code + "\"><summary><span class=\"count\">" +
             with_thousands(list.count) + "</span><code>" + code + "</code><span>" + escaped(info(list.code).meaning) +
             "</span></summary>\n<ul class=\"objects\">\n";
      for (const ListedRow& row : list.rows) {
        out += "<li>" + osm_link(row.object);
        if (row.building != model::kNoIndex && std::binary_search(marks.begin(), marks.end(), row.building))
          out += " <a class=\"small\" href=\"#at-" + footprints.buildings[row.building].osm.text() + "\">map</a>";
        if (const std::string_view detail = without_id(row); !detail.empty())
          out += " <span class=\"soft\">" + escaped(detail) + "</span>";
        out += "</li>\n";
      }
      out += "</ul>\n" + limit_note(list.count, options.listed_objects) + "</details>\n";
    }
  }
  // Objects that another one stands for are no issue, but nothing mapped goes unmentioned.
  struct Others {
    model::ObjectState state;
    std::string_view id, text;
  };
  constexpr Others kOthers[] = {
      {model::ObjectState::represented, "represented", "Represented by its parts: it has no body of its own."},
      {model::ObjectState::duplicate, "duplicate", "Mapped twice: the other object is modelled."}};
  bool first = true;
  for (const Others& others : kOthers) {
    std::string items;
    std::uint64_t count = 0;
    for (const ReportedObject& object : facts.objects) {
      if (object.state != others.state || ++count > options.listed_objects) continue;
      items += "<li>" + osm_link(object.id) + " <span class=\"soft\">by</span> " + osm_link(object.related) + "</li>\n";
    }
    if (count == 0) continue;
    if (first)
      out += "<h3>Represented by others <span class=\"soft\">" + with_thousands(facts.represented + facts.duplicates) +
             "</span></h3>\n";
    first = false;
    out += "<details class=\"code\" id=\"objects-" + std::string(others.id) + "\"><summary><span class=\"count\">" +
           with_thousands(count) + "</span><code>" + std::string(others.id) + "</code><span>" +
           std::string(others.text) + "</span></summary>\n<ul class=\"objects\">\n" + items + "</ul>\n" +
           limit_note(count, options.listed_objects) + "</details>\n";
  }
  return out + "</section>\n";
}

std::string map_section(const ReportMap& map, const ReportFacts& facts) {
  std::string out = "<section id=\"map\">\n<h2>Map</h2>\n";
  if (map.svg.empty()) return out + "<p>No building has a footprint.</p>\n</section>\n";
  out += "<div class=\"themes\">\n";
  constexpr std::string_view kThemes[kMapThemes] = {"Storeys", "Source of the storeys", "Roofs", "Issues"};
  for (std::size_t t = 0; t < kMapThemes; ++t) {
    const std::string id = std::string("by-") + kThemeLetter[t];
    out += "<input type=\"radio\" name=\"by\" id=\"" + id + "\"" + (t == 0 ? " checked=\"checked\"" : "") +
           "/><label for=\"" + id + "\">" + std::string(kThemes[t]) + "</label>\n";
  }
  out += map.svg;
  constexpr std::string_view kStoreys[kStoreyClasses] = {"not built", "1 storey", "2",      "3",          "4",
                                                         "5",         "6",        "7 to 9", "10 and more"};
  constexpr std::string_view kRoofs[kRoofClasses] = {
      "not built", "flat", "gabled", "hipped, pyramidal", "mansard, gambrel", "shed", "round, dome, spire", "other"};
  constexpr std::string_view kIssues[kIssueClasses] = {"as asked", "mended or noticed", "simpler than asked",
                                                       "not built"};
  for (std::size_t t = 0; t < kMapThemes; ++t) {
    out += std::string("<ul class=\"key legend of-") + kThemeLetter[t] + "\">";
    for (std::size_t k = 0; k < map.counts[t].size(); ++k) {
      const std::uint64_t n = map.counts[t][k];
      if (n == 0) continue;
      std::string_view text;
      switch (static_cast<MapTheme>(t)) {
        case MapTheme::storeys:
          text = kStoreys[k];
          break;
        case MapTheme::source:
          text = k == 0 ? "not built" : model::name(static_cast<model::Source>(k - 1));
          break;
        case MapTheme::roof:
          text = kRoofs[k];
          break;
        case MapTheme::issue:
          text = kIssues[k];
          break;
      }
      out +=
          "<li><svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 10 10\" aria-hidden=\"true\"><rect class=\"c" +
          std::to_string(k) + "\" width=\"10\" height=\"10\" rx=\"2\"/></svg>" + std::string(text) + "<b>" +
          with_thousands(n) + "</b></li>";
    }
    out += "</ul>\n";
  }
  out += "</div>\n<p class=\"small soft\">";
  if (!map.note.empty()) out += map.note + " ";
  if (map.outside > 0)
    out += with_thousands(map.outside) + (map.outside == 1 ? " building lies" : " buildings lie") +
           " far from the others, outside of the map. ";
  if (map.without_area > 0)
    out += with_thousands(map.without_area) + (map.without_area == 1 ? " building has" : " buildings have") +
           " no footprint left. ";
  out += "Numbers count buildings. Map data " + escaped(facts.attribution) + ".</p>\n";
  return out + "</section>\n";
}

}  // namespace blockrand::outputs
