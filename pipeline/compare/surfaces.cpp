#include "pipeline/compare/surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pipeline/base/portable_math.h"
#include "pipeline/compare/area_vector.h"
#include "pipeline/compare/surface_samples.h"

namespace blockrand::compare {

namespace {

constexpr std::array<double, 3> kBounds{0.25, 0.5, 1.0};  // m, of completeness and correctness
constexpr double kSameWall = 1.0;   // m. A wall farther from a left-out one is another wall, and wrong.
constexpr double kRounding = 1e-6;  // m. What lies at a bound but for rounding lies within it.
constexpr double kDegrees = 180 / std::numbers::pi;

struct Place {
  double distance = 0, weight = 0, angle = 0;  ///< m, m², degrees
  LeftOut why = LeftOut::no;
};

/// One way: places on `from`, the nearest of each on `to`.
struct OneWay {
  std::vector<Place> places;
  double farthest_all = 0, farthest_counted = 0;  ///< m, corners of faces included
};

bool is_upright(const MatchSurface::Patch& p) { return p.opening || p.hull == Hull::wall; }

OneWay walk(const MatchSurface& from, const Cover& from_cover, const MatchSurface& to, const Cover& to_cover,
            double up_from, double up_to, double spacing, std::uint64_t seed) {
  OneWay out;
  // Covers know the heights that their cities have, surfaces those that can be compared.
  const auto reason = [](const MatchSurface::Patch& patch, const Cover& cover, Point3 at, double up) {
    if (patch.left_out == LeftOut::ground || patch.left_out == LeftOut::blank) return patch.left_out;
    if (is_upright(patch) && cover.covered(patch.building, {at.x, at.y, at.z - up}, patch.normal))
      return LeftOut::covered;
    return LeftOut::no;
  };
  const auto look = [&](const MatchSurface::Patch& patch, Point3 at, double weight) {
    Place place;
    const auto nearest = to.nearest_patch(at, patch.normal);
    place.distance = nearest.distance;
    place.weight = weight;
    const MatchSurface::Patch& other = *nearest.patch;
    place.angle = base::acos(std::min(1.0, nearest.cosine)) * kDegrees;
    place.why = reason(patch, from_cover, at, up_from);
    if (place.why == LeftOut::no && is_upright(patch) && is_upright(other)) {
      const LeftOut there = place.distance <= kSameWall ? reason(other, to_cover, nearest.place, up_to) : LeftOut::no;
      if (there != LeftOut::ground) place.why = there;
    }
    return place;
  };
  for (const MatchSurface::Patch& patch : from.patches()) {
    const auto triangles = from.triangles_of_patch(patch);
    for_each_sample(triangles, patch.normal, patch.anchor, spacing, seed,
                    [&](Point3 at, double weight) { out.places.push_back(look(patch, at, weight)); });
    for (const Triangle3& t : triangles)
      for (const Point3& corner : t) {
        const Place place = look(patch, corner, 0);
        out.farthest_all = std::max(out.farthest_all, place.distance);
        if (place.why == LeftOut::no) out.farthest_counted = std::max(out.farthest_counted, place.distance);
      }
  }
  for (const Place& p : out.places) {
    out.farthest_all = std::max(out.farthest_all, p.distance);
    if (p.why == LeftOut::no) out.farthest_counted = std::max(out.farthest_counted, p.distance);
  }
  return out;
}

/// Weighted sums over places.
struct Sums {
  double weight = 0, distance = 0, squares = 0, angle = 0;
  std::array<double, kBounds.size()> within{};
  void add(const Place& p) {
    weight += p.weight;
    distance += p.weight * p.distance;
    squares += p.weight * p.distance * p.distance;
    angle += p.weight * p.angle;
    for (std::size_t i = 0; i < kBounds.size(); ++i) within[i] += p.distance <= kBounds[i] + kRounding ? p.weight : 0;
  }
};

Sums sums_of(const std::vector<Place>& places, bool counted_only) {
  Sums sums;
  for (const Place& p : places)
    if (!counted_only || p.why == LeftOut::no) sums.add(p);
  return sums;
}

std::optional<double> p95_of(const OneWay& a, const OneWay& b, bool counted_only) {
  std::vector<std::pair<double, double>> all;
  double total = 0;
  for (const OneWay* way : {&a, &b})
    for (const Place& p : way->places)
      if (!counted_only || p.why == LeftOut::no) {
        all.emplace_back(p.distance, p.weight);
        total += p.weight;
      }
  if (all.empty()) return std::nullopt;
  std::sort(all.begin(), all.end());
  double sum = 0;
  for (const auto& [distance, weight] : all)
    if ((sum += weight) >= 0.95 * total) return distance;
  return all.back().first;
}

/// Steps of quarter octaves, so that the lattice does not follow the last digit of an area.
double spacing_of(double area, const SurfaceOptions& options) {
  constexpr double kStep = 1.189207115002721;  // fourth root of 2
  const double wanted = std::sqrt(area / std::max(1, options.samples));
  double spacing = options.least_spacing;
  while (spacing * kStep <= wanted) spacing *= kStep;
  return spacing;
}

}  // namespace

MatchSurface::MatchSurface(const City& city, std::span<const std::uint32_t> buildings, double up) : nearest_({}) {
  for (const std::uint32_t b : buildings) {
    const Building& building = city.buildings[b];
    Point3 anchor{1e300, 1e300, 1e300};
    for (const Face& f : building.faces)
      for (const Point3& p : f.rings[0])
        anchor = {std::min(anchor.x, p.x), std::min(anchor.y, p.y), std::min(anchor.z, p.z + up)};
    const auto add = [&](const Rings3& rings, Patch patch) {
      patch.building = b;
      patch.anchor = anchor;
      patch.first = static_cast<std::uint32_t>(triangles_.size());
      for (Triangle3 t : triangles_of(rings)) {
        for (Point3& p : t) p.z += up;
        area_ += length(cross(t[1] - t[0], t[2] - t[0])) / 2;
        triangles_.push_back(t);
        patch_of_.push_back(static_cast<std::uint32_t>(patches_.size()));
      }
      patch.count = static_cast<std::uint32_t>(triangles_.size()) - patch.first;
      if (patch.count > 0) patches_.push_back(patch);
    };
    for (const Face& f : building.faces) add(f.rings, {.hull = f.hull, .left_out = f.left_out, .normal = f.normal});
    for (const Opening& o : building.openings)
      for (const Rings3& rings : o.polygons) {
        const Point3 n = area_vector(rings[0]);
        const double l = length(n);
        if (l > 0) add(rings, {.opening = true, .normal = {n.x / l, n.y / l, n.z / l}});
      }
  }
  nearest_ = geometry::NearestSurface(triangles_);
}

MatchSurface::NearestPatch MatchSurface::nearest_patch(Point3 p, Point3 normal) const {
  const auto nearest = nearest_.nearest(p);
  NearestPatch out{nearest.distance, &patch_of(nearest.triangle), 0, nearest.place};
  out.cosine = std::fabs(dot(normal, out.patch->normal));
  constexpr double kAlike = 1 - 1e-9;  // no other one can look more alike
  if (out.cosine >= kAlike) return out;
  for (const std::uint32_t t : nearest_.triangles_at(nearest.place)) {
    const Patch& patch = patch_of(t);
    const double cosine = std::fabs(dot(normal, patch.normal));
    if (cosine > out.cosine + 1e-9) out = {nearest.distance, &patch, cosine, nearest.place};
  }
  return out;
}

DistanceHistogram::DistanceHistogram() : weights_(4000 + 720 + 1, 0) {}

std::size_t DistanceHistogram::bin(double d) {
  // A distance on a bound lies below it, rounding included.
  const auto below = [](double steps) { return static_cast<std::size_t>(std::max(0.0, std::ceil(steps - 1e-3) - 1)); };
  if (d <= 4) return below(d * 1000);
  if (d <= 40) return 4000 + std::min<std::size_t>(719, below((d - 4) * 20));
  return 4720;
}

double DistanceHistogram::upper(std::size_t bin) {
  return bin < 4000 ? static_cast<double>(bin + 1) / 1000 : 4 + static_cast<double>(bin - 4000 + 1) / 20;
}

void DistanceHistogram::add(const DistanceHistogram& other) {
  for (std::size_t i = 0; i < weights_.size(); ++i) weights_[i] += other.weights_[i];
}

double DistanceHistogram::total() const {
  double sum = 0;
  for (const double w : weights_) sum += w;
  return sum;
}

double DistanceHistogram::share_up_to(double distance) const {
  const double all = total();
  if (all <= 0) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < weights_.size() && upper(i) <= distance + 1e-9; ++i) sum += weights_[i];
  return sum / all;
}

double DistanceHistogram::quantile(double share) const {
  const double all = total();
  if (all <= 0) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < weights_.size(); ++i)
    if ((sum += weights_[i]) >= share * all) return upper(i);
  return upper(weights_.size() - 1);
}

void measure_surfaces(const MatchSurface& model, const Cover& model_cover, const MatchSurface& reference,
                      const Cover& reference_cover, double model_up, double reference_up, const SurfaceOptions& options,
                      MeasureValues& values, SurfaceTally& tally) {
  if (model.empty() || reference.empty()) return;
  const double spacing = spacing_of(std::max(model.area(), reference.area()), options);
  const OneWay there =
      walk(model, model_cover, reference, reference_cover, model_up, reference_up, spacing, options.seed);
  const OneWay back =
      walk(reference, reference_cover, model, model_cover, reference_up, model_up, spacing, options.seed);
  double reference_area = 0, left_out = 0;
  for (const Place& p : there.places) {
    tally.model[static_cast<std::size_t>(p.why)] += p.weight;
    if (p.why == LeftOut::no) tally.to_reference.add(p.distance, p.weight);
  }
  for (const Place& p : back.places) {
    tally.reference[static_cast<std::size_t>(p.why)] += p.weight;
    reference_area += p.weight;
    if (p.why == LeftOut::no)
      tally.to_model.add(p.distance, p.weight);
    else
      left_out += p.weight;
  }
  const double share = reference_area > 0 ? left_out / reference_area : 0;

  const auto set = [&](Measure m, bool counted, double weight, std::optional<double> value) {
    MeasureValue& v = values[static_cast<std::size_t>(m)];
    if (!value) return;
    (counted ? v.counted : v.all) = value;
    (counted ? v.weight : v.weight_all) = weight;
    v.left_out = share;
  };
  for (const bool counted : {true, false}) {
    const Sums a = sums_of(there.places, counted), b = sums_of(back.places, counted);
    const double both = a.weight + b.weight;
    if (a.weight > 0) {
      set(Measure::to_reference_mean, counted, a.weight, a.distance / a.weight);
      set(Measure::correctness_025, counted, a.weight, a.within[0] / a.weight);
      set(Measure::correctness_050, counted, a.weight, a.within[1] / a.weight);
      set(Measure::correctness_100, counted, a.weight, a.within[2] / a.weight);
    }
    if (b.weight > 0) {
      set(Measure::to_model_mean, counted, b.weight, b.distance / b.weight);
      set(Measure::completeness_025, counted, b.weight, b.within[0] / b.weight);
      set(Measure::completeness_050, counted, b.weight, b.within[1] / b.weight);
      set(Measure::completeness_100, counted, b.weight, b.within[2] / b.weight);
    }
    if (a.weight <= 0 || b.weight <= 0) continue;
    set(Measure::distance_mean, counted, both, (a.distance + b.distance) / both);
    set(Measure::distance_rms, counted, both, std::sqrt((a.squares + b.squares) / both));
    set(Measure::distance_p95, counted, both, p95_of(there, back, counted));
    set(Measure::distance_max, counted, both,
        counted ? std::max(there.farthest_counted, back.farthest_counted)
                : std::max(there.farthest_all, back.farthest_all));
    set(Measure::normal_deviation, counted, both, (a.angle + b.angle) / both);
  }
}

}  // namespace blockrand::compare
