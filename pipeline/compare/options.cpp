#include "pipeline/compare/options.h"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/base/option.h"

namespace blockrand::compare {
namespace {

using base::choice;
using base::custom;
using base::integer;
using base::number;
using base::OptionRecord;
using base::OptionType;
using base::text;
using base::texts;
using base::ValueError;
using C = CompareOptions;
using importers::reference::AxisOrder;
using importers::reference::ReadOptions;

const base::Choices<AxisOrder> kAxisOrders = {
    {"auto", AxisOrder::automatic}, {"east-first", AxisOrder::east_first}, {"north-first", AxisOrder::north_first}};
const base::Choices<Align> kAligns = {
    {"none", Align::none}, {"horizontal", Align::horizontal}, {"vertical", Align::vertical}, {"both", Align::both}};
const base::Choices<Heights> kHeights = {
    {"auto", Heights::automatic}, {"own-ground", Heights::own_ground}, {"absolute", Heights::absolute}};

georef::Geodetic parse_origin(const std::string& text) {
  const std::string remedy =
      "Write longitude,latitude in degrees and height in m above the ellipsoid: 13.404,52.536,80.";
  const std::vector<std::string> parts = base::split(text, ',');
  if (parts.size() != 3) throw ValueError(base::in_quotes(text) + " does not have three numbers", remedy);
  const georef::Geodetic origin{base::parse_number(parts[0], remedy), base::parse_number(parts[1], remedy),
                                base::parse_number(parts[2], remedy)};
  if (std::abs(origin.lon) > 180 || std::abs(origin.lat) > 90)
    throw ValueError(base::in_quotes(text) + " is no place", remedy);
  return origin;
}

std::string show_origin(const std::optional<georef::Geodetic>& o) {
  return o ? fmt::format("{},{},{}", base::shortest(o->lon), base::shortest(o->lat), base::shortest(o->height)) : "";
}

/// An option that two models have, each by a name of its own.
struct NameAndHelp {
  std::string_view name, help;
};

/// What a user may know about either model beyond what its files say.
base::OptionTable<C> reading(NameAndHelp crs, NameAndHelp axes, NameAndHelp origin, ReadOptions C::*model) {
  return base::of_member<C, ReadOptions>(
      {text({.name = crs.name, .argument = "EPSG:CODE", .commands = base::kCompare, .help = crs.help},
            &ReadOptions::reference_crs),
       choice({.name = axes.name, .argument = "ORDER", .commands = base::kCompare, .help = axes.help}, kAxisOrders,
              &ReadOptions::axis_order),
       custom<ReadOptions>(
           {.name = origin.name,
            .argument = "LON,LAT,H",
            .type = OptionType::list,
            .commands = base::kCompare,
            .help = origin.help},
           [](ReadOptions& r, const std::string& text) { r.gltf_origin = parse_origin(text); },
           [](const ReadOptions& r) { return show_origin(r.gltf_origin); })},
      model);
}

base::OptionTable<C> measuring() {
  return {
      text({.name = "MODEL",
            .argument = "PATH",
            .type = OptionType::path,
            .commands = base::kCompare,
            .help = "what is judged: a build's folder, or any file or folder as REFERENCE",
            .if_missing = "no MODEL is given: name a build or model files."},
           &C::model),
      texts({.name = "REFERENCE",
             .argument = "PATH",
             .type = OptionType::path,
             .commands = base::kCompare,
             .help = "what it is judged by, one or more: CityGML, CityJSON, glTF, a tileset, or a folder with any of "
                     "them",
             .if_missing = "no REFERENCE is given: name at least one file or folder to compare with."},
            &C::reference),
      choice({.name = "align",
              .argument = "WHAT",
              .commands = base::kCompare,
              .help = "which offset between the models is taken off before measuring: none (it is reported only), "
                      "horizontal, vertical or both"},
             kAligns, &C::align),
      choice({.name = "heights",
              .argument = "WHICH",
              .commands = base::kCompare,
              .help = "own-ground: above each building's own ground; absolute: as they stand in the files; auto: "
                      "absolute where both models say that theirs are above the same sea level or ellipsoid"},
             kHeights, &C::heights),
      integer({.name = "max-lod",
               .argument = "N",
               .commands = base::kCompare,
               .minimum = 1,
               .maximum = 4,
               .help = "of each building the highest level of detail up to this one is compared"},
              &C::max_lod),
      number({.name = "reach",
              .argument = "METRES",
              .commands = base::kCompare,
              .minimum = 0,
              .maximum = 100000,
              .help = "buildings farther than this from all of the other model's are no part of the comparison, in m"},
             &C::reach),
      base::of_member(integer({.name = "samples",
                               .argument = "N",
                               .commands = base::kCompare,
                               .minimum = 100,
                               .maximum = 10000000,
                               .help = "places on the surface of each side of a match from which distances are "
                                       "measured, about"},
                              &SurfaceOptions::samples),
                      &C::surface)};
}

}  // namespace

const base::OptionSection kCompareSection{.name = "compare", .title = "How models are compared"};

base::OptionTable<CompareOptions> compare_options() {
  return base::in_section(
      kCompareSection,
      base::concatenated(
          {measuring(),
           reading({"model-crs", "the model's coordinate system, where its files state none or a wrong one"},
                   {"model-axis-order",
                    "which coordinate comes first in the model's files: auto, east-first or north-first"},
                   {"model-origin",
                    "where a model as glTF has its origin, if the file does not say: degrees, m above the ellipsoid"},
                   &C::model_read),
           reading(
               {"reference-crs", "the reference's coordinate system, where its files state none or a wrong one"},
               {"reference-axis-order",
                "which coordinate comes first in the reference's files: auto, east-first or north-first"},
               {"reference-origin",
                "where a reference as glTF has its origin, if the file does not say: degrees, m above the ellipsoid"},
               &C::reference_read)}));
}

base::OptionTable<ReportOptions> report_options() {
  return base::in_section<ReportOptions>(
      kCompareSection, {integer({.name = "pictures",
                                 .argument = "N",
                                 .commands = base::kCompare,
                                 .minimum = 0,
                                 .maximum = 100000,
                                 .help = "so many matches get pictures in compare.html, those that differ most first",
                                 .record = OptionRecord::none},
                                &ReportOptions::pictures)});
}

}  // namespace blockrand::compare
