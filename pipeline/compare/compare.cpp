#include "pipeline/compare/compare.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "pipeline/base/parallel.h"
#include "pipeline/compare/body.h"
#include "pipeline/compare/cover.h"
#include "pipeline/compare/read_city.h"
#include "pipeline/compare/summary.h"
#include "pipeline/geometry/box_index.h"

namespace blockrand::compare {

namespace {

geometry::PlanBox box_of(const City& city, double margin) {
  geometry::PlanBox box;
  for (const Building& b : city.buildings) box.include(plan_box(b));
  if (box.empty()) return box;
  box.minimum = {box.minimum.x - margin, box.minimum.y - margin};
  box.maximum = {box.maximum.x + margin, box.maximum.y + margin};
  return box;
}

/// Buildings far from all of the other model are no part of the comparison, and no miss either.
void drop_out_of_reach(City& city, const City& other, double reach) {
  if (other.buildings.empty()) return;
  std::vector<geometry::PlanBox> boxes;
  for (const Building& b : other.buildings) boxes.push_back(plan_box(b));
  const geometry::BoxIndex index(std::move(boxes));
  city.out_of_reach +=
      std::erase_if(city.buildings, [&](const Building& b) { return index.near(plan_box(b), reach).empty(); });
}

/// Whether heights over sea level or the ellipsoid are compared.
bool absolute_heights(const City& model, const City& reference, Heights heights) {
  if (heights != Heights::automatic) return heights == Heights::absolute;
  // Sea level and ellipsoid are some 40 m apart, and two sea levels some decimetres.
  return model.absolute_heights && reference.absolute_heights && model.height_reference == reference.height_reference;
}

/// m that the model's side of a match is raised by, so that heights can be compared.
double model_up(const MatchResult& match, bool absolute) {
  if (absolute || !match.model.ground || !match.reference.ground) return 0;
  return *match.reference.ground - *match.model.ground;
}

void settle_registration(City& model, const City& reference, bool absolute, const CompareOptions& options,
                         Registration& r) {
  r = register_models(model, reference, absolute, options.match);
  if (r.matches == 0) {
    r.rule = "no buildings match: no offset was estimated";
    return;
  }
  Point3 by;
  if (options.align == Align::horizontal || options.align == Align::both) {
    by.x = -r.east;
    by.y = -r.north;
    r.horizontal_removed = true;
  }
  if ((options.align == Align::vertical || options.align == Align::both) && r.up) {
    by.z = -*r.up;
    r.vertical_removed = true;
  }
  if (r.horizontal_removed || r.vertical_removed) move(model, by);
  if (options.align == Align::none)
    r.rule = "reported only: removed where --align asks for it";
  else if (options.align != Align::horizontal && !r.vertical_removed)
    r.rule = "no vertical offset is known: heights are compared above each building's own ground";
  else
    r.rule = "removed as --align asks";
}

/// Ids of matches, unique: that of the reference's first building.
void name_matches(Comparison& c) {
  std::set<std::string> taken;
  for (MatchResult& m : c.matches) {
    const std::string& id = c.reference.buildings[m.reference.buildings[0]].id;
    m.id = id;
    for (int n = 2; !taken.insert(m.id).second; ++n) m.id = id + "#" + std::to_string(n);
  }
}

}  // namespace

Comparison compare_cities(City model, City reference, const CompareOptions& options, base::Progress& progress) {
  Comparison c;
  c.model = std::move(model);
  c.reference = std::move(reference);
  progress.begin("matching");
  drop_out_of_reach(c.model, c.reference, options.reach);
  drop_out_of_reach(c.reference, c.model, options.reach);
  c.absolute_heights = absolute_heights(c.model, c.reference, options.heights);
  settle_registration(c.model, c.reference, c.absolute_heights, options, c.registration);

  const Registration& r = c.registration;
  const Point2 shift = r.horizontal_removed ? Point2{} : Point2{r.east, r.north};
  const std::vector<Match> matches = match_buildings(c.model, c.reference, shift, options.match);
  std::vector<bool> model_taken(c.model.buildings.size()), reference_taken(c.reference.buildings.size());
  std::vector<std::vector<std::uint32_t>> groups;
  for (const Match& m : matches) {
    for (const std::uint32_t i : m.model) model_taken[i] = true;
    for (const std::uint32_t i : m.reference) reference_taken[i] = true;
    groups.push_back(m.reference);
  }
  for (std::uint32_t i = 0; i < model_taken.size(); ++i)
    if (!model_taken[i]) c.extra.push_back(i);
  for (std::uint32_t i = 0; i < reference_taken.size(); ++i)
    if (!reference_taken[i]) c.missing.push_back(i);

  c.missing_covered = covered_shares(c.reference, c.missing, c.model, shift);
  c.extra_covered = covered_shares(c.model, c.extra, c.reference, {-shift.x, -shift.y});

  const Cover model_cover(c.model), reference_cover(c.reference);
  mark_left_out(c.model, model_cover, options.jobs);
  mark_left_out(c.reference, reference_cover, options.jobs);
  c.blank_facades = mark_blank(c.reference, groups, options.facade);

  progress.begin("measuring", matches.size(), "matches");
  c.matches.resize(matches.size());
  std::vector<SurfaceTally> tallies(matches.size());
  SurfaceTally tally;
  const int workers = base::worker_count(options.jobs);
  base::ordered_parallel(
      matches.size(), workers, static_cast<std::size_t>(workers) * 4,
      [&](std::size_t i) {
        MatchResult& out = c.matches[i];
        out.model = side_facts(c.model, matches[i].model);
        out.reference = side_facts(c.reference, matches[i].reference);
        tell_roofs(c.model, out.model, c.reference, out.reference);
        measure_bodies(c.model, out.model, c.reference, out.reference, c.absolute_heights, out.values);
        const double up = model_up(out, c.absolute_heights);
        measure_surfaces(MatchSurface(c.model, out.model.buildings, up), model_cover,
                         MatchSurface(c.reference, out.reference.buildings, 0), reference_cover, up, 0, options.surface,
                         out.values, tallies[i]);
        out.model.left_out = tallies[i].model;
        out.reference.left_out = tallies[i].reference;
        // The reference's ground also where heights are absolute: drawings and cellars need one.
        const double zero = out.reference.ground.value_or(out.model.ground.value_or(0));
        out.facades = compare_facades(c.model, out.model.buildings, zero - up, c.reference, out.reference.buildings,
                                      zero, options.facade);
        measure_facades(out.facades, c.model, out.model.buildings, c.reference, out.reference.buildings, out.values);
      },
      [&](std::size_t i) {
        const SurfaceTally done = std::exchange(tallies[i], {});
        tally.to_reference.add(done.to_reference);
        tally.to_model.add(done.to_model);
        const auto form = [](RoofForm f) { return static_cast<std::size_t>(f); };
        ++c.roof_confusion[form(c.matches[i].reference.roof_form)][form(c.matches[i].model.roof_form)];
        progress.advance_to(i + 1);
      });
  progress.end();

  name_matches(c);
  c.summaries = summarise(c.matches);
  c.model_total = total_of(c.matches, true);
  c.reference_total = total_of(c.matches, false);
  for (const double d : {0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0}) {
    c.distances.upto.push_back(d);
    c.distances.to_reference.push_back(tally.to_reference.share_up_to(d));
    c.distances.to_model.push_back(tally.to_model.share_up_to(d));
  }
  c.distances.p95_to_reference = tally.to_reference.quantile(0.95);
  c.distances.p95_to_model = tally.to_model.quantile(0.95);
  return c;
}

Comparison compare_models(const CompareOptions& options, base::Progress& progress) {
  progress.begin("reading the reference");
  ReadCityOptions read;
  read.read = options.reference_read;
  read.crs = options.crs;
  read.max_lod = options.max_lod;
  read.jobs = options.jobs;
  City reference = read_city(options.reference, read);
  progress.begin("reading the model");
  read.read = options.model_read;
  read.crs = reference.crs;
  read.origin = reference.origin;
  // A wide margin: what an offset hides is found again once it is known.
  read.reach = box_of(reference, options.reach + options.match.largest_offset);
  City model = read_city({options.model}, read);
  progress.end();
  return compare_cities(std::move(model), std::move(reference), options, progress);
}

DistanceQuery distance_query(const Comparison& c) {
  return [&c](const MatchResult& match, bool from_model, std::span<const Point3> points) {
    const double up = model_up(match, c.absolute_heights);
    const MatchSurface other = from_model ? MatchSurface(c.reference, match.reference.buildings, 0)
                                          : MatchSurface(c.model, match.model.buildings, up);
    std::vector<float> out;
    out.reserve(points.size());
    for (const Point3& p : points)
      out.push_back(
          other.empty() ? 0.0f : static_cast<float>(other.nearest({p.x, p.y, p.z + (from_model ? up : 0)}).distance));
    return out;
  };
}

}  // namespace blockrand::compare
