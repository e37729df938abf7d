#include "pipeline/compare/summary.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pipeline/base/portable_math.h"

namespace blockrand::compare {

namespace {

struct Weighted {
  double value, weight;
};

/// The value at a share of sorted values, by the nearest rank.
double quantile(const std::vector<double>& sorted, double share) {
  const auto n = static_cast<double>(sorted.size());
  const auto rank = static_cast<std::size_t>(std::max(1.0, std::ceil(share * n - 1e-9)));
  return sorted[rank - 1];
}

double pooled(const std::vector<Weighted>& values, Pool pool) {
  double sum = 0, weight = 0, largest = values[0].value;
  for (const Weighted& v : values) {
    weight += v.weight;
    largest = std::max(largest, v.value);
    switch (pool) {
      case Pool::mean:
        sum += v.weight * v.value;
        break;
      case Pool::rms:
        sum += v.weight * v.value * v.value;
        break;
      case Pool::sum:
        sum += v.value;
        break;
      case Pool::max:
        break;
    }
  }
  if (pool == Pool::max) return largest;
  if (pool == Pool::sum) return sum;
  if (weight <= 0) return 0;
  return pool == Pool::rms ? std::sqrt(sum / weight) : sum / weight;
}

Summary summary_of(const std::vector<Weighted>& values, const MeasureInfo& measure) {
  Summary out;
  out.count = values.size();
  if (values.empty()) return out;
  const auto n = static_cast<double>(values.size());
  std::vector<double> sorted, absolute;
  for (const Weighted& v : values) {
    sorted.push_back(v.value);
    absolute.push_back(std::fabs(v.value));
    out.mean += v.value / n;
    out.mean_abs += std::fabs(v.value) / n;
    out.rms += v.value * v.value / n;
  }
  out.rms = std::sqrt(out.rms);
  std::sort(sorted.begin(), sorted.end());
  std::sort(absolute.begin(), absolute.end());
  const std::size_t middle = sorted.size() / 2;
  out.median = sorted.size() % 2 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
  out.p95_abs = quantile(absolute, 0.95);
  out.min = sorted.front();
  out.max = sorted.back();
  out.pooled = pooled(values, measure.pool);
  if (measure.better == Better::one) out.mean_factor = mean_factor(sorted);
  return out;
}

/// What a match's left-out share is a share of.
double scope_area(const MatchResult& match, Scope scope) {
  if (scope == Scope::surface) {
    double area = 0;  // as the places say from which the share comes, openings included
    for (const double a : match.reference.left_out) area += a;
    return area;
  }
  if (scope == Scope::facades) {
    double area = 0;
    for (const Facade& f : match.facades.reference) area += f.area;
    return area;
  }
  return 1;
}

}  // namespace

double mean_factor(std::span<const double> ratios) {
  if (ratios.empty()) return 1;
  double sum = 0;
  for (const double ratio : ratios) sum += std::fabs(base::log(std::clamp(ratio, 0.01, 100.0)));
  return base::exp(sum / static_cast<double>(ratios.size()));
}

MeasureSummaries summarise(std::span<const MatchResult> matches) {
  MeasureSummaries out;
  for (std::size_t m = 0; m < kMeasureCount; ++m) {
    std::vector<Weighted> counted, all;
    double left = 0, area = 0;
    for (const MatchResult& match : matches) {
      const MeasureValue& v = match.values[m];
      if (v.counted) counted.push_back({*v.counted, v.weight});
      if (v.all) all.push_back({*v.all, v.weight_all});
      if (!v.counted && !v.all) continue;
      const double here = scope_area(match, kMeasures[m].scope);
      left += v.left_out * here;
      area += here;
    }
    out[m].counted = summary_of(counted, kMeasures[m]);
    out[m].all = summary_of(all, kMeasures[m]);
    out[m].left_out = area > 0 ? left / area : 0;
  }
  return out;
}

SideFacts total_of(std::span<const MatchResult> matches, bool model) {
  SideFacts out;
  bool has_volume = !matches.empty();
  double volume = 0;
  for (const MatchResult& match : matches) {
    const SideFacts& side = model ? match.model : match.reference;
    out.footprint_area += side.footprint_area;
    out.surface_area += side.surface_area;
    for (std::size_t i = 0; i < out.area_of.size(); ++i) out.area_of[i] += side.area_of[i];
    for (std::size_t i = 0; i < out.left_out.size(); ++i) out.left_out[i] += side.left_out[i];
    out.unclassified_area += side.unclassified_area;
    if (side.volume)
      volume += *side.volume;
    else
      has_volume = false;
    out.solids += side.solids;
    out.valid_solids += side.valid_solids;
    for (const auto& [defect, n] : side.defects) out.defects[defect] += n;
    out.openings += side.openings;
    out.triangles += side.triangles;
  }
  if (has_volume) out.volume = volume;
  return out;
}

}  // namespace blockrand::compare
