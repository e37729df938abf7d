#include "pipeline/context/height_reference.h"

#include <fmt/format.h>

#include <cctype>

#include "importers/elevation/terrain.h"
#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"
#include "pipeline/georef/transform.h"

namespace blockrand::context {

namespace {

using importers::elevation::TerrainDescription;
using Kind = AskedReference::Kind;

constexpr const char* kOption = "--terrain-height-reference";
constexpr const char* kChoices =
    "sea-level (taken for EGM96), ellipsoid, or the EPSG code of a vertical coordinate system, such as EPSG:7837";

/// What the raster says of itself, in the form of the option.
AskedReference said_by(const TerrainDescription& terrain) {
  AskedReference said;
  if (terrain.ellipsoidal) said.kind = Kind::ellipsoid;
  if (!terrain.vertical_name.empty()) {
    said.kind = Kind::vertical_crs;
    said.vertical_code = terrain.vertical_code;
    said.vertical_name = terrain.vertical_name;
  }
  return said;
}

bool contradict(const AskedReference& said, const AskedReference& asked) {
  if (said.kind == Kind::unsaid || asked.kind == Kind::unsaid) return false;
  if (asked.kind == Kind::sea_level) return said.kind == Kind::ellipsoid;  // any height system is above some sea level
  return said.kind != asked.kind || said.vertical_code != asked.vertical_code;
}

std::string in_words(const AskedReference& reference) {
  switch (reference.kind) {
    case Kind::unsaid:
      return "nothing";
    case Kind::sea_level:
      return "sea level";
    case Kind::ellipsoid:
      return "the ellipsoid";
    case Kind::vertical_crs:
      break;
  }
  return reference.vertical_code.empty() ? reference.vertical_name
                                         : fmt::format("{} ({})", reference.vertical_name, reference.vertical_code);
}

}  // namespace

std::string ground_warning(const georef::LonLat& place) {
  const std::string begin = "no --terrain and no --ground-height: ", end = ". Give --ground-height or --terrain";
  const std::string unknown = "how high the ground itself is, nothing says";
  const std::optional<double> sea = georef::Geoid().undulation(place.lon, place.lat);
  if (!sea)
    return begin + "on a globe (3D Tiles) houses will stand at height 0 of the ellipsoid, not on the ground" + end;
  if (*sea >= 0.5)
    return begin +
           fmt::format(
               "on a globe (3D Tiles) houses will lie {:.0f} m below the sea level of the place, so at least that "
               "far below land above the sea; {}",
               *sea, unknown) +
           end;
  if (*sea <= -0.5)
    return begin +
           fmt::format(
               "on a globe (3D Tiles) houses will lie {:.0f} m above the sea level of the place: above lower ground, "
               "within higher ground; {}",
               -*sea, unknown) +
           end;
  return begin + "on a globe (3D Tiles) houses will lie at the sea level of the place; " + unknown + end;
}

AskedReference read_height_reference(const std::string& text) {
  AskedReference asked;
  if (text.empty()) return asked;
  std::string lower;
  for (const char c : text) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (lower == "sea-level") {
    asked.kind = Kind::sea_level;
    return asked;
  }
  if (lower == "ellipsoid") {
    asked.kind = Kind::ellipsoid;
    return asked;
  }
  const std::string number = lower.starts_with("epsg:") ? lower.substr(5) : std::string();
  const bool digits = !number.empty() && number.find_first_not_of("0123456789") == std::string::npos;
  const georef::VerticalCrs crs = digits ? georef::vertical_crs_of("EPSG:" + number) : georef::VerticalCrs{};
  const std::string meant = base::nearest(lower, {"sea-level", "ellipsoid"});
  if (crs.name.empty() || crs.authority_code != "EPSG:" + number)
    throw base::UsageError(fmt::format("{} {}: is no vertical coordinate system.{} Give {}", kOption, text,
                                       meant.empty() ? "" : " Did you mean " + meant + "?", kChoices));
  if (crs.downwards)
    throw base::UsageError(fmt::format("{} {}: {} counts downwards. Give {}", kOption, text, crs.name, kChoices));
  asked.kind = Kind::vertical_crs;
  asked.vertical_code = crs.authority_code;
  asked.vertical_name = crs.name;
  asked.metres_per_unit = crs.metres_per_unit;
  return asked;
}

HeightReference choose_height_reference(const TerrainDescription* terrain, const AskedReference& asked,
                                        bool has_ground_height) {
  HeightReference out;
  if (terrain == nullptr && asked.kind != Kind::unsaid)
    throw base::UsageError(std::string(kOption) + " says what the heights of --terrain are above: it needs --terrain");
  if (terrain == nullptr && !has_ground_height) {
    out.words = "heights above local ground";
    out.in_tiles = out.words + ", ground at ellipsoid height 0";
    return out;
  }
  AskedReference reference;
  if (terrain != nullptr) {
    const AskedReference said = said_by(*terrain);
    reference = asked.kind == Kind::unsaid ? said : asked;
    if (reference.kind == Kind::unsaid)
      throw base::UsageError(fmt::format("{}: the raster does not say what its heights are above. Add {} with {}",
                                         terrain->path, kOption, kChoices));
    if (contradict(said, asked))
      out.warnings.push_back(
          fmt::format("{}: its heights are above {} by its own words; taken for heights above {} as {} says",
                      terrain->path, in_words(said), in_words(asked), kOption));
  }
  switch (reference.kind) {
    case Kind::unsaid:
      out.words = "heights above sea level, one ground height for all";
      out.raised_from = georef::kEgm96;
      break;
    case Kind::sea_level:
      out.words = "heights of the terrain raster, above sea level";
      out.raised_from = georef::kEgm96;
      break;
    case Kind::ellipsoid:
      out.words = "heights of the terrain raster, above the ellipsoid";
      out.in_tiles = out.words;
      return out;
    case Kind::vertical_crs: {
      out.words = "heights of the terrain raster, above " + in_words(reference);
      out.raised_from = reference.vertical_code;
      // Heights are in metres here, whatever the raster counts in.
      const bool metres = georef::vertical_crs_of(reference.vertical_code).metres_per_unit == 1;
      if (metres && reference.vertical_code.starts_with("EPSG:")) out.vertical_crs = reference.vertical_code;
      break;
    }
  }
  const georef::Geoid geoid(out.raised_from);
  if (!geoid.available()) {
    out.in_tiles = out.words + ", taken for ellipsoidal";
    out.warnings.push_back("heights above sea level are taken for ellipsoidal ones in 3D Tiles: " +
                           georef::Geoid::remedy());
    return out;
  }
  out.raised_by = geoid;
  out.in_tiles = out.words + ", raised to the ellipsoid by " + geoid.words();
  if (geoid.stands_in()) out.warnings.push_back("3D Tiles: heights are raised to the ellipsoid by " + geoid.words());
  return out;
}

}  // namespace blockrand::context
