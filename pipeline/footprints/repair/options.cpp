#include "pipeline/footprints/repair/options.h"

#include "pipeline/base/option.h"

namespace blockrand::repair {
namespace {

using base::flag;
using base::number;
using R = RepairOptions;

constexpr base::OptionSection kRepair{.name = "repair", .title = "How far repair may go", .tuning = true};
constexpr int kNoPlace = base::OptionDescription::kNoPlace;

base::Option<R> metres(std::string_view name, std::string_view key, double minimum, double maximum,
                       std::string_view help, double R::*member, int record_place = kNoPlace) {
  return number({.name = name,
                 .key = key,
                 .argument = "METRES",
                 .minimum = minimum,
                 .maximum = maximum,
                 .help = help,
                 .record_place = record_place},
                member);
}

base::Option<R> square_metres(std::string_view name, std::string_view key, double maximum, std::string_view help,
                              double R::*member, int record_place = kNoPlace) {
  return number({.name = name,
                 .key = key,
                 .argument = "M2",
                 .minimum = 0,
                 .maximum = maximum,
                 .help = help,
                 .record_place = record_place},
                member);
}

/// A share of an area.
base::Option<R> share(std::string_view name, std::string_view key, std::string_view help, double R::*member,
                      int record_place = kNoPlace) {
  return number({.name = name,
                 .key = key,
                 .argument = "SHARE",
                 .minimum = 0,
                 .maximum = 1,
                 .help = help,
                 .record_place = record_place},
                member);
}

base::OptionTable<R> steps() {
  return {flag({.name = "repair-simplify",
                .key = "simplify",
                .help = "remove points on straight walls",
                .without = "points on straight walls stay",
                .record_place = 7},
               &R::simplify),
          flag({.name = "repair-share-walls",
                .key = "share_walls",
                .help = "join walls of neighbours that almost meet",
                .without = "gaps between neighbours stay as mapped",
                .record_place = 9},
               &R::share_walls),
          flag({.name = "repair-resolve-overlaps",
                .key = "resolve_overlaps",
                .help = "buildings that overlap at one level give way to each other",
                .without = "overlaps of neighbours stay",
                .record_place = 14},
               &R::resolve_overlaps),
          flag({.name = "repair-settle-coverings",
                .key = "settle_coverings",
                .help = "settle houses mapped twice, and outlines around mapped houses",
                .without = "houses mapped twice are built twice",
                .record_place = 13},
               &R::settle_coverings),
          flag({.name = "repair-square",
                .key = "square",
                .help = "make almost right corners right",
                .without = "almost right corners stay as mapped",
                .record_place = 10},
               &R::square),
          flag({.name = "repair-fit-parts",
                .key = "fit_parts",
                .help = "fit parts to their repaired outline; build what they leave of it",
                .without = "parts stay as mapped, what they leave of an outline is not built",
                .record_place = 11},
               &R::fit_parts),
          flag({.name = "repair-arcs",
                .key = "arcs",
                .help = "record rounded walls as arcs",
                .without = "rounded walls are not recorded; what repair does to them stays the same",
                .record_place = 12},
               &R::arcs)};
}

base::OptionTable<R> bounds() {
  return {
      metres("repair-duplicate-distance", "duplicate_distance", 0, 0.5,
             "nearer neighbours on a ring are one point, in m", &R::duplicate_distance, 1),
      metres("repair-spike-width", "spike_width", 0, 1, "a tip narrower than this is removed, in m", &R::spike_width,
             2),
      square_metres("repair-min-piece-area", "min_piece_area", 100,
                    "smaller pieces of a repaired outline are dropped and reported, in m2", &R::min_piece_area, 3),
      share("repair-max-ring-area-change", "max_ring_area_change",
            "of the area, by mending invalid rings; more is reported", &R::max_ring_area_change, 15),
      metres("repair-ring-clearance", "ring_clearance", 0.002, 0.5, "rings that touch are moved apart by this, in m",
             &R::ring_clearance, 4),
      metres("repair-collinear-distance", "collinear_distance", 0, 0.5,
             "a point nearer to the wall through its neighbours is no corner, in m", &R::collinear_distance, 8),
      metres("repair-snap-distance", "snap_distance", 0, 2, "walls of neighbours at this mean distance are one, in m",
             &R::snap_distance),
      metres("repair-snap-reach", "snap_reach", 0, 3, "... and at this distance at their ends, in m", &R::snap_reach),
      number({.name = "repair-snap-angle",
              .key = "snap_angle",
              .argument = "RADIANS",
              .minimum = 0,
              .maximum = 0.5,
              .help = "steeper pairs of walls are corners, not one wall"},
             &R::snap_angle),
      metres("repair-min-overlap", "min_overlap", 0, 10, "shorter contacts stay two walls, in m", &R::min_overlap),
      metres("repair-max-shift", "max_shift", 0, 2, "no corner moves farther by sharing and squaring, in m",
             &R::max_shift),
      share("repair-max-area-change", "max_area_change", "of the area, by sharing and squaring; more is undone",
            &R::max_area_change),
      square_metres("repair-min-overlap-area", "min_overlap_area", 100,
                    "larger overlaps of neighbours are resolved or reported, in m2", &R::min_overlap_area),
      share("repair-max-loss", "max_loss", "of its area that a building may lose to a neighbour it overlaps",
            &R::max_loss),
      square_metres("repair-parts-free-area", "parts_free_area", 100000,
                    "what parts leave of an outline is built when it is larger than this, in m2", &R::parts_free_area,
                    5),
      metres("repair-parts-free-width", "parts_free_width", 0, 100, "... and wider than this, in m",
             &R::parts_free_width, 6)};
}

}  // namespace

base::OptionTable<RepairOptions> repair_options() {
  return base::in_section(kRepair, base::concatenated({steps(), bounds()}));
}

}  // namespace blockrand::repair
