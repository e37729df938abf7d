#include "pipeline/outputs/cityjson/metadata_text.h"

namespace blockrand::outputs {
namespace {

/// The schema knows six members of metadata and no others, so what CityGML says in its description stands in the title.
std::string title(const CityJsonOptions& options) {
  std::string text = options.name;
  const auto add = [&](std::string_view label, std::string_view value) {
    if (value.empty()) return;
    if (!text.empty()) text += "; ";
    text += label;
    text += value;
  };
  add("heights: ", options.height_reference);
  add("vertical CRS: ", options.vertical_crs);
  add("data: ", options.attribution);
  add("written by ", options.generator);
  return text;
}

bool is_date(std::string_view text) {
  if (text.size() < 10) return false;
  for (std::size_t i = 0; i < 10; ++i)
    if (i == 4 || i == 7 ? text[i] != '-' : text[i] < '0' || text[i] > '9') return false;
  return true;
}

}  // namespace

void append_member(std::string& out, std::string_view name, bool first) {
  out += first ? "\"" : ",\"";
  out += name;
  out += "\":";
}

void append_vertex(std::string& out, const GridPoint& p) {
  out += '[';
  append_number(out, p.x);
  out += ',';
  append_number(out, p.y);
  out += ',';
  append_number(out, p.z);
  out += ']';
}

void append_transform(std::string& out, const GridOrigin& origin) {
  out += "{\"scale\":[0.0009765625,0.0009765625,0.0009765625],\"translate\":[";
  append_number(out, origin.x);
  out += ',';
  append_number(out, origin.y);
  out += ',';
  append_number(out, origin.z);
  out += "]}";
}

void append_metadata(std::string& out, const CityJsonOptions& options, const Extent& extent, const GridOrigin& origin) {
  out += '{';
  bool first = true;
  const auto member = [&](std::string_view name) {
    append_member(out, name, first);
    first = false;
  };
  if (const std::string text = title(options); !text.empty()) {
    member("title");
    append_json(out, text);
  }
  if (is_date(options.data_time)) {
    member("referenceDate");
    append_json(out, std::string_view(options.data_time).substr(0, 10));
  }
  const std::string& code = options.crs_code;
  if (const std::size_t colon = code.find(':'); colon != std::string::npos && colon > 0 && colon + 1 < code.size()) {
    member("referenceSystem");
    append_json(out, "https://www.opengis.net/def/crs/" + code.substr(0, colon) + "/0/" + code.substr(colon + 1));
  }
  if (!extent.empty) {
    member("geographicalExtent");
    append_extent(out, extent, origin);
  }
  out += '}';
}

}  // namespace blockrand::outputs
