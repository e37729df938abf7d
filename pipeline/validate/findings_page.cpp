#include <fmt/format.h>
#include <libxml/xmlreader.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <unordered_set>

#include "pipeline/validate/attribute_names.h"
#include "pipeline/validate/bytes_of_file.h"
#include "pipeline/validate/ids.h"
#include "pipeline/validate/report_check.h"

namespace blockrand::validate {
namespace {

constexpr const char* kFile = "report.html";

/// What the page says, taken from its structure.
struct Page {
  std::vector<std::string> sums;             ///< the large numbers at the top
  std::map<std::string, std::string> codes;  ///< code → count
  /// By row of the table of sources: title, and source → bodies.
  std::vector<std::pair<std::string, std::map<std::string, std::uint64_t>>> sources;
  std::vector<std::string> footprints;  ///< ids on the map
  std::vector<std::string> outside;     ///< what the page would load from elsewhere
  std::string wrong;                    ///< not empty: not well-formed
};

std::string attribute(xmlTextReaderPtr reader, const char* name) {
  xmlChar* value = xmlTextReaderGetAttribute(reader, reinterpret_cast<const xmlChar*>(name));
  const std::string text = value ? reinterpret_cast<const char*>(value) : "";
  xmlFree(value);
  return text;
}

class Reader {
 public:
  Page read(const std::string& html) {
    // Entities that stand for entities make gigabytes of half a kilobyte, and HUGE takes away libxml2's guard against
    // them.
    if (html.find("<!ENTITY") != std::string::npos) {
      page_.wrong = "declares entities, which no page of Blockrand has";
      return std::move(page_);
    }
    constexpr int kOptions =
        XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_HUGE;  // pictures are long attributes
    const std::unique_ptr<xmlTextReader, void (*)(xmlTextReaderPtr)> reader(
        html.empty() || html.size() > 0x7fffffff
            ? nullptr
            : xmlReaderForMemory(html.data(), static_cast<int>(html.size()), kFile, "UTF-8", kOptions),
        xmlFreeTextReader);
    int status = -1;
    if (reader) {
      xmlTextReaderSetErrorHandler(
          reader.get(), [](void*, const char*, xmlParserSeverities, xmlTextReaderLocatorPtr) {}, nullptr);
      while ((status = xmlTextReaderRead(reader.get())) == 1) node(reader.get());
    }
    if (status != 0)
      page_.wrong =
          fmt::format("line {}: not well-formed", reader ? xmlTextReaderGetParserLineNumber(reader.get()) : 0);
    return std::move(page_);
  }

 private:
  struct Open {
    std::string name, id, classes;
  };

  void node(xmlTextReaderPtr reader) {
    switch (xmlTextReaderNodeType(reader)) {
      case XML_READER_TYPE_ELEMENT: {
        Open open{reinterpret_cast<const char*>(xmlTextReaderConstLocalName(reader)), attribute(reader, "id"),
                  attribute(reader, "class")};
        const bool empty = xmlTextReaderIsEmptyElement(reader) == 1;
        text_.clear();
        for (const char* link : {"src", "href"})
          if (const std::string target = attribute(reader, link); !target.empty() && loads(open.name, target))
            page_.outside.push_back(target.substr(0, 80));
        if (open.name == "path" && is_osm_id(open.id)) page_.footprints.push_back(open.id);
        stack_.push_back(std::move(open));
        if (empty) end();
        break;
      }
      case XML_READER_TYPE_END_ELEMENT:
        end();
        break;
      case XML_READER_TYPE_TEXT:
      case XML_READER_TYPE_CDATA:
        text_ += reinterpret_cast<const char*>(xmlTextReaderConstValue(reader));
        break;
      default:
        break;
    }
  }

  /// Links may lead anywhere; what is shown must be in the page.
  static bool loads(const std::string& element, const std::string& target) {
    return (element == "img" || element == "script" || element == "link" || element == "image" || element == "use" ||
            element == "iframe") &&
           !target.starts_with("data:") && !target.starts_with("#");
  }

  const Open* up(std::size_t n) const { return stack_.size() > n ? &stack_[stack_.size() - 1 - n] : nullptr; }

  void end() {
    if (stack_.empty()) return;
    const Open& open = stack_.back();
    if (open.name == "b" && up(2) && up(2)->classes == "sum") page_.sums.push_back(text_);
    if (open.name == "span" && open.classes == "count" && up(2) && up(2)->id.starts_with("code-"))
      page_.codes[up(2)->id.substr(5)] = text_;
    if (open.name == "td" && stack_.size() > 3 && up(3)->classes == "sources" && open.classes.empty())
      page_.sources.push_back({text_, {}});
    if (open.name == "title" && up(3) && up(3)->classes == "bar") {
      // "tag 163 (100 %)"
      const std::size_t space = text_.find(' '), bracket = text_.find(" (");
      if (space != text_.npos && bracket != text_.npos && bracket > space && !page_.sources.empty())
        page_.sources.back().second[text_.substr(0, space)] =
            number_of(text_.substr(space + 1, bracket - space - 1)).value_or(0);
    }
    stack_.pop_back();
    text_.clear();
  }

 public:
  /// "1,234"; nothing for anything else.
  static std::optional<std::uint64_t> number_of(std::string text) {
    std::erase(text, ',');
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
  }

 private:
  Page page_;
  std::vector<Open> stack_;
  std::string text_;
};

std::map<std::string, std::uint64_t> counts_of(const Json* object) {
  std::map<std::string, std::uint64_t> out;
  if (object && object->is_object())
    for (const auto& [name, count] : object->items()) out[name] = whole(&count).value_or(0);
  return out;
}

}  // namespace

std::uint64_t check_report_page(const std::string& folder, const BuildRecord& record,
                                const std::set<std::string>* buildings, FindingLog& log) {
  const auto html = file_bytes((std::filesystem::path(folder) / kFile).string());
  if (!html) return 0;  // that it is missing was found already
  const auto wrong = [&](const std::string& object, std::string what) {
    log.add(Check::report_wrong, kFile, object, std::move(what));
  };
  const Page page = Reader().read(*html);
  if (!page.wrong.empty()) {
    log.add(Check::file_unreadable, kFile, "", page.wrong);
    return 0;
  }
  for (const std::string& target : page.outside) wrong("", "loads " + target + " from elsewhere");
  std::uint64_t compared = 0;
  const auto compare = [&](const std::string& what, const std::string& said, std::uint64_t is) {
    ++compared;
    if (Reader::number_of(said) != is)
      wrong(what, fmt::format("{} on the page, {} in build.json", said.empty() ? "nothing" : said, is));
  };
  const auto count = [&](const char* key) { return record.count(key).value_or(0); };
  const std::pair<const char*, std::uint64_t> sums[] = {{"mapped objects", count("buildings_in") + count("parts_in")},
                                                        {"modelled", count("models")},
                                                        {"represented", count("represented")},
                                                        {"not modelled", count("reported")}};
  for (std::size_t i = 0; i < std::size(sums); ++i)
    compare(sums[i].first, i < page.sums.size() ? page.sums[i] : "", sums[i].second);

  std::map<std::string, std::uint64_t> issues = counts_of(member(record.json, "issues"));
  for (const auto& [code, said] : page.codes) issues.try_emplace(code, 0);
  for (const auto& [code, is] : issues) {
    const auto said = page.codes.find(code);
    compare(code, said == page.codes.end() ? "" : said->second, is);
  }

  // Rows stand in the order of the attributes; those that no body has are left out.
  const Json* sources = member(member(record.json, "statistics"), "sources");
  auto row = page.sources.begin();
  for (const std::string& name : attribute_names()) {
    const auto is = counts_of(member(sources, name));
    if (is.empty()) continue;
    ++compared;
    if (row == page.sources.end()) {
      wrong(name, "has no bar");
    } else {
      if (row->second != is) wrong(row->first, "its bar does not show the counts of " + name + " in build.json");
      ++row;
    }
  }
  for (; row != page.sources.end(); ++row) wrong(row->first, "is no attribute of build.json");

  std::unordered_set<std::string> shown;
  for (const std::string& id : page.footprints)
    if (!shown.insert(id).second) wrong(id, "stands twice on the map");
  // Of a whole city the map shows cells, not buildings.
  if (buildings && !shown.empty()) {
    for (const std::string& id : page.footprints)
      if (!buildings->count(id)) wrong(id, "stands on the map, but not in the model");
    for (const std::string& id : *buildings)
      if (!shown.count(id)) wrong(id, "stands in the model, but not on the map");
    compared += shown.size();
  }
  return compared;
}

}  // namespace blockrand::validate
