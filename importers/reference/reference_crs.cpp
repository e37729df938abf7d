#include "importers/reference/reference_crs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "importers/reference/coordinate_text.h"
#include "pipeline/base/error.h"
#include "pipeline/georef/crs_facts.h"
#include "pipeline/georef/transform.h"

namespace blockrand::importers::reference {
namespace {

bool all_digits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::vector<std::string> split(std::string_view text, std::string_view separators) {
  std::vector<std::string> out(1);
  for (const char c : text) {
    if (separators.find(c) != std::string_view::npos) {
      out.emplace_back();
    } else {
      out.back() += c;
    }
  }
  return out;
}

/// "EPSG:25832" of the words of an urn, address or short form: the authority and the last word that is a code.
std::string code_in(const std::vector<std::string>& words) {
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    const std::string authority = lower_case(words[i]);
    if (authority != "epsg" && authority != "ogc" && authority != "epsg.xml") continue;
    const std::string& code = words.back();
    if (authority == "ogc") {
      if (code.size() > 3 && lower_case(code).starts_with("crs")) return "OGC:" + code;  // CRS84
    } else if (all_digits(code)) {
      return "EPSG:" + code;
    }
  }
  return "";
}

/// Codes of one srsName, horizontal first: the urn or address is cut where a compound one joins its parts.
std::vector<std::string> codes_in(std::string_view text, std::string_view joints) {
  std::vector<std::string> out;
  for (const std::string& piece : split(text, joints)) {
    const std::string code = code_in(split(piece, ":/#="));
    if (!code.empty()) out.push_back(code);
  }
  return out;
}

/// The zone at the end of "ETRS89_UTM32" or "32": one or two digits after `prefix`, also with the leading digit of the
/// central meridian's zone ("zE-N"). 0: none.
int zone_after(std::string_view text, std::string_view prefix) {
  const std::size_t at = text.find(prefix);
  if (at == std::string_view::npos) return 0;
  int zone = 0;
  for (std::size_t i = at + prefix.size(); i < text.size() && text[i] >= '0' && text[i] <= '9' && zone < 100; ++i)
    zone = zone * 10 + (text[i] - '0');
  return zone;
}

/// The German surveys' own names (AdV, GeoInfoDok): horizontal*vertical.
SrsName parse_adv(std::string_view text) {
  SrsName out;
  const auto parts = split(text, "*");
  const int utm = zone_after(parts[0], "ETRS89_UTM"), gauss = zone_after(parts[0], "DE_DHDN_3GK");
  if (utm >= 28 && utm <= 38) out.horizontal = "EPSG:" + std::to_string(25800 + utm);
  if (gauss >= 2 && gauss <= 5) out.horizontal = "EPSG:" + std::to_string(31464 + gauss);
  if (parts.size() > 1 && parts[1].starts_with("DE_DHHN92")) out.vertical = "EPSG:5783";
  if (parts.size() > 1 && parts[1].starts_with("DE_DHHN2016")) out.vertical = "EPSG:7837";
  return out;
}

/// Whether a place lies in a box that is `margin` degrees wider on each side.
bool lies_in(const georef::GeoBox& box, georef::LonLat p, double margin) {
  if (!std::isfinite(p.lon) || !std::isfinite(p.lat)) return false;
  if (p.lat < box.south - margin || p.lat > box.north + margin) return false;
  double east_of_west = p.lon - (box.west - margin);
  while (east_of_west < 0) east_of_west += 360;
  return east_of_west <= box.width() + 2 * margin;
}

/// Places in degrees of coordinates in the CRS; nothing where PROJ has no way.
std::optional<georef::Transform> to_degrees(const ReferenceCrs& crs) {
  try {
    return georef::Transform(crs.horizontal, "EPSG:4326");
  } catch (const base::UsageError&) {
    return std::nullopt;
  }
}

}  // namespace

SrsName parse_srs_name(const std::string& text) {
  SrsName out;
  const std::string_view name = trimmed(text);
  const std::string lower = lower_case(name);
  const std::size_t adv = lower.find("adv:crs:");
  if (adv != std::string::npos) {
    out = parse_adv(name.substr(adv + 8));
  } else if (all_digits(name)) {
    out.horizontal = "EPSG:" + std::string(name);
  } else {
    const bool urn = lower.starts_with("urn:"), address = lower.starts_with("http");
    std::vector<std::string> codes = codes_in(name, urn ? "," : address ? "?&" : "+,");
    // "EPSG:25832+5783": the second code stands alone.
    if (const auto plus = split(name, "+"); codes.size() == 1 && plus.size() == 2 && all_digits(plus[1]))
      codes.push_back("EPSG:" + plus[1]);
    if (!codes.empty()) out.horizontal = codes[0];
    if (codes.size() > 1) out.vertical = codes[1];
    out.authority_order = urn || lower.find("/def/crs") != std::string::npos;
  }
  if (out.horizontal.empty()) out.horizontal = name;
  return out;
}

ReferenceCrs decide_crs(const std::string& path, const std::vector<std::string>& stated, const ReadOptions& options,
                        NoteLog& notes) {
  ReferenceCrs crs;
  if (!stated.empty()) crs.stated = stated[0];
  crs.from_options = !options.reference_crs.empty();
  const std::string& text = crs.from_options ? options.reference_crs : crs.stated;
  const SrsName parsed = parse_srs_name(text);
  const auto facts = parsed.horizontal.empty() ? std::nullopt : georef::crs_facts(parsed.horizontal);
  if (!facts) {
    if (crs.from_options)
      throw base::UsageError("--reference-crs (of the judged model: --model-crs) " + text +
                             " is no coordinate reference system that PROJ knows");
    throw base::InputError(path, "",
                           crs.stated.empty()
                               ? "no srsName or referenceSystem says in which coordinate reference system it is"
                               : "unknown coordinate reference system \"" + text + "\"",
                           "--reference-crs (of the judged model: --model-crs) EPSG:... names it");
  }
  crs.horizontal = facts->authority_code.empty() ? parsed.horizontal : facts->authority_code;
  crs.name = facts->name;
  crs.vertical = parsed.vertical.empty() ? facts->vertical_code : parsed.vertical;
  crs.geographic = facts->geographic;
  crs.metres_per_unit = facts->metres_per_unit;
  const bool latitude_first = facts->geographic && facts->north_first && parsed.authority_order;
  crs.axis_order = latitude_first ? AxisOrder::north_first : AxisOrder::east_first;
  for (const std::string& other : stated) {
    const SrsName o = parse_srs_name(other);
    if (o.horizontal == parsed.horizontal) continue;
    if (crs.from_options) {
      notes.add(NoteKind::crs, 0, "the file states \"" + other + "\", read as " + crs.horizontal + " as asked for");
    } else if (const auto f = georef::crs_facts(o.horizontal); !f || f->authority_code != crs.horizontal) {
      notes.add(NoteKind::mixed_crs, 0, "\"" + other + "\" beside \"" + text + "\"");
    }
  }
  return crs;
}

void decide_axis_order(ReferenceCrs& crs, const model::Point2& lowest, const model::Point2& highest,
                       const ReadOptions& options, NoteLog& notes) {
  if (options.axis_order != AxisOrder::automatic) {
    crs.axis_order = options.axis_order;
    return;
  }
  // Areas of use are generous boxes, and models lie a little over their zone's edge now and then.
  constexpr double kMargin = 1.0;  // degrees
  const auto transform = to_degrees(crs);
  const auto facts = georef::crs_facts(crs.horizontal);
  if (!transform || !facts) return;
  const model::Point2 centre{(lowest.x + highest.x) / 2, (lowest.y + highest.y) / 2};
  const auto place = [&](AxisOrder order) {
    const model::Point2 p = order == AxisOrder::north_first ? model::Point2{centre.y, centre.x} : centre;
    if (crs.geographic && (std::fabs(p.x) > 360 || std::fabs(p.y) > 90)) return georef::LonLat{NAN, NAN};
    const model::Point2 q = transform->forward(p);
    return georef::LonLat{q.x, q.y};
  };
  const AxisOrder usual = crs.axis_order,
                  other = usual == AxisOrder::east_first ? AxisOrder::north_first : AxisOrder::east_first;
  const auto fits = [&](const std::optional<georef::GeoBox>& box, AxisOrder order, double margin) {
    return box && lies_in(*box, place(order), margin);
  };
  const std::string order_text = other == AxisOrder::north_first ? "north before east" : "east before north";
  constexpr double kNear = 0.05;  // degrees: models may reach over the edge of what they are compared with
  const auto from_near = [&](AxisOrder order) {  // squared degrees, longitudes as long as latitudes: a comparison only
    const georef::LonLat p = place(order), c = options.near->centre();
    return (p.lon - c.lon) * (p.lon - c.lon) + (p.lat - c.lat) * (p.lat - c.lat);
  };
  const bool usual_near = fits(options.near, usual, kNear), other_near = fits(options.near, other, kNear);
  if (usual_near && (!other_near || from_near(usual) <= from_near(other))) return;
  if (other_near) {
    crs.axis_order = other;
    notes.add(NoteKind::crs, 0, order_text + ": so the model lies where it is expected");
    return;
  }
  const bool usual_fits = fits(facts->area, usual, kMargin), other_fits = fits(facts->area, other, kMargin);
  if (other_fits && !usual_fits) {
    crs.axis_order = other;
    notes.add(NoteKind::crs, 0, order_text + ": only so the model lies in the area of use of " + crs.name);
  } else if (other_fits && usual_fits && !facts->geographic && facts->north_first) {
    notes.add(NoteKind::crs, 0,
              "east before north as files usually have it; " + crs.name +
                  " is defined the other way round, and both orders lie in its area of use");
  } else if (!usual_fits && facts->area) {
    notes.add(NoteKind::crs, 0, "the model lies outside of the area of use of " + crs.name);
  }
}

}  // namespace blockrand::importers::reference
