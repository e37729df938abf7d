// The outline of gables in the plane of their wall.
#include <algorithm>
#include <cmath>

#include "styles/roofs/gables.h"

namespace blockrand::roofs {

using model::Point2;
using model::Point3;

namespace {

constexpr std::size_t kMostEdges = 400;  ///< of the roof behind a gable; their crossings are looked for in pairs
constexpr double kSamePlace = 1e-6;      ///< m
constexpr double kBefore = 0.01;         ///< m before the edge: walls that are not quite straight
constexpr double kClear = 0.02;          ///< m: a level piece shorter than this is no side of a solid
constexpr double kStraight = 0.002;      ///< m: a point of a silhouette this near to its neighbours' line bends nothing

/// What of a ring lies where `inside` is not negative (Sutherland and Hodgman).
template <class Inside>
std::vector<Point3> kept(const std::vector<Point3>& ring, Inside inside) {
  std::vector<Point3> out;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point3 &p = ring[i], &q = ring[(i + 1) % ring.size()];
    const double at_p = inside(p), at_q = inside(q);
    if (at_p >= 0) out.push_back(p);
    if ((at_p < 0) == (at_q < 0)) continue;
    const double share = at_p / (at_p - at_q);
    out.push_back({p.x + share * (q.x - p.x), p.y + share * (q.y - p.y), p.z + share * (q.z - p.z)});
  }
  return out;
}

struct Line {
  OutlinePoint a, b;  ///< a.along <= b.along
};

double height_on(const Line& l, double along) {
  if (l.b.along - l.a.along < kSamePlace) return std::max(l.a.height, l.b.height);
  return l.a.height + (along - l.a.along) / (l.b.along - l.a.along) * (l.b.height - l.a.height);
}

/// The way in from the start until a silhouette rises above `height`; its whole width where it never does.
double way_below(std::span<const OutlinePoint> s, double height) {
  if (s.front().height > height) return 0;
  for (std::size_t i = 1; i < s.size(); ++i) {
    if (s[i].height <= height) continue;
    const double share = (height - s[i - 1].height) / (s[i].height - s[i - 1].height);
    return s[i - 1].along + share * (s[i].along - s[i - 1].along);
  }
  return s.back().along;
}

double highest_until(std::span<const OutlinePoint> s, double along) {
  double most = s.front().height;
  for (std::size_t i = 1; i < s.size(); ++i) {
    if (s[i].along <= along) {
      most = std::max(most, s[i].height);
      continue;
    }
    const double share = (along - s[i - 1].along) / (s[i].along - s[i - 1].along);
    return std::max(most, s[i - 1].height + share * (s[i].height - s[i - 1].height));
  }
  return most;
}

/// One flank of a stepped outline: how far in each level but the top one reaches. Empty where the roof there is too
/// steep.
std::optional<std::vector<double>> flank(std::span<const OutlinePoint> silhouette, std::span<const double> levels,
                                         double lead, double least, double overtop) {
  const double width = silhouette.back().along;
  const double widest = width / (2 * static_cast<double>(levels.size()) - 1);
  std::vector<double> ends;
  // A side that is as high as the top has no flank: the roof ends upright there.
  if (silhouette.front().height > levels[levels.size() - 2] - overtop) return ends;
  double before = 0;
  for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
    const double end = std::min(way_below(silhouette, levels[k] - overtop), before + widest);
    if (end - before < (k == 0 ? std::max(least, lead + least) : least)) return std::nullopt;
    ends.push_back(end);
    before = end;
  }
  return ends;
}

/// Point of a quadratic Bezier curve; t in [0, 1] (docs/sources.md, Holtmeier 4.4).
OutlinePoint bezier(OutlinePoint c0, OutlinePoint c1, OutlinePoint c2, double t) {
  const auto at = [t](double a, double b, double c) { return (a - 2 * b + c) * t * t + (-2 * a + 2 * b) * t + a; };
  return {at(c0.along, c1.along, c2.along), at(c0.height, c1.height, c2.height)};
}

/// The left half of an outline, up to and with the beginning of the top level.
std::vector<OutlinePoint> half_outline(std::span<const double> ends, std::span<const double> levels, double lead,
                                       const GableOptions& options) {
  if (ends.empty()) return {{0, levels.back()}};
  std::vector<OutlinePoint> out{{0, levels[0]}};
  double before = 0;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const double low = levels[k], high = levels[k + 1], end = ends[k];
    if (options.form == GableForm::stepped) {
      out.push_back({end, low});
      out.push_back({end, high});
    } else {
      const double start = k == 0 && lead > 0 ? lead + kClear : before, middle = (start + end) / 2,
                   half = (low + high) / 2;
      if (start > out.back().along) out.push_back({start, low});
      for (int i = 1; i <= options.segments; ++i)
        out.push_back(bezier({start, low}, {middle, low}, {middle, half}, static_cast<double>(i) / options.segments));
      for (int i = 1; i <= options.segments; ++i)
        out.push_back(bezier({middle, half}, {middle, high}, {end, high}, static_cast<double>(i) / options.segments));
    }
    before = end;
  }
  return out;
}

}  // namespace

std::vector<OutlinePoint> roof_silhouette(const Roof& roof, const PlanEdge& edge, double depth) {
  const Point2 in = edge.inward();
  std::vector<Line> lines;
  const auto place = [&](const Point3& p) {
    const double x = p.x - edge.from.x, y = p.y - edge.from.y;
    return Point3{x * edge.along.x + y * edge.along.y, x * in.x + y * in.y, p.z};
  };
  for (const auto& surface : roof.surfaces) {
    if (surface.upright) continue;
    // What of it lies in the band, with the band's borders: a plane is highest on the border of what is seen of it.
    std::vector<Point3> ring;
    for (const Point3& p : surface.loops[0]) ring.push_back(place(p));
    ring = kept(ring, [](const Point3& p) { return p.x; });
    ring = kept(ring, [&](const Point3& p) { return edge.length - p.x; });
    ring = kept(ring, [](const Point3& p) { return p.y + kBefore; });
    ring = kept(ring, [&](const Point3& p) { return depth - p.y; });
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point3 &p = ring[i], &q = ring[(i + 1) % ring.size()];
      Line line{{p.x, p.z}, {q.x, q.z}};
      if (line.a.along > line.b.along) std::swap(line.a, line.b);
      lines.push_back(line);
    }
  }
  if (lines.empty() || lines.size() > kMostEdges) return {};
  std::vector<double> places{0, edge.length};
  for (const Line& l : lines) {
    places.push_back(l.a.along);
    places.push_back(l.b.along);
  }
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t k = i + 1; k < lines.size(); ++k) {
      const double start = std::max(lines[i].a.along, lines[k].a.along),
                   end = std::min(lines[i].b.along, lines[k].b.along);
      if (end - start < kSamePlace) continue;
      const double at_start = height_on(lines[i], start) - height_on(lines[k], start),
                   at_end = height_on(lines[i], end) - height_on(lines[k], end);
      if (at_start * at_end < 0) places.push_back(start + (end - start) * at_start / (at_start - at_end));
    }
  std::sort(places.begin(), places.end());
  std::vector<OutlinePoint> all;
  for (double s : places) {
    s = std::clamp(s, 0.0, edge.length);
    if (!all.empty() && s - all.back().along < kSamePlace) continue;
    double most = -1e18;
    for (const Line& l : lines)
      if (l.a.along <= s + kSamePlace && s <= l.b.along + kSamePlace)
        most = std::max(most, height_on(l, std::clamp(s, l.a.along, l.b.along)));
    if (most > -1e17) all.push_back({s, most});
  }
  std::vector<OutlinePoint> out;
  for (const OutlinePoint& p : all) {
    while (out.size() >= 2) {
      const OutlinePoint &a = out[out.size() - 2], &b = out.back();
      const double on_line = a.height + (b.along - a.along) / (p.along - a.along) * (p.height - a.height);
      if (std::fabs(on_line - b.height) > kStraight) break;
      out.pop_back();
    }
    out.push_back(p);
  }
  return out;
}

std::optional<std::vector<OutlinePoint>> gable_outline(std::span<const OutlinePoint> silhouette, double lead_in,
                                                       double lead_out, const GableOptions& options) {
  const bool stepped = options.form == GableForm::stepped;
  if (stepped ? options.steps < 3 || options.steps > 5 : options.curves < 1 || options.curves > 2) return std::nullopt;
  if (options.form == GableForm::attic || silhouette.size() < 2 || options.segments < 1) return std::nullopt;
  const int count = stepped ? options.steps : options.curves + 1;
  std::vector<OutlinePoint> mirrored;
  const double width = silhouette.back().along;
  for (auto p = silhouette.rbegin(); p != silhouette.rend(); ++p) mirrored.push_back({width - p->along, p->height});
  double top = silhouette.front().height;
  for (const OutlinePoint& p : silhouette) top = std::max(top, p.height);
  const double eaves = std::min(silhouette.front().height, silhouette.back().height);
  const double least =
      stepped ? options.least_tread : 4 * options.least_tread;  // a curve takes the tread of several steps
  // A roof that rises steeply from the eaves (a mansard) lifts the first level, so that it has a tread.
  const double first_tread = least + std::max(lead_in, lead_out);
  double lifted = eaves;
  for (const auto& side : {silhouette, std::span<const OutlinePoint>(mirrored)})
    if (side.front().height < top - options.overtop) lifted = std::max(lifted, highest_until(side, first_tread));
  const double first = std::max(eaves + (top - eaves) / count, lifted) + options.overtop;
  std::vector<double> levels;
  for (int k = 0; k < count; ++k) levels.push_back(first + (top + options.overtop - first) * k / (count - 1));
  constexpr double kLeastRiser = 0.10;  // m
  if (levels[1] - levels[0] < kLeastRiser) return std::nullopt;
  const auto left = flank(silhouette, levels, lead_in, least, options.overtop),
             right = flank(mirrored, levels, lead_out, least, options.overtop);
  if (!left || !right || (left->empty() && right->empty())) return std::nullopt;
  auto out = half_outline(*left, levels, lead_in, options);
  const auto other = half_outline(*right, levels, lead_out, options);
  for (auto p = other.rbegin(); p != other.rend(); ++p) out.push_back({width - p->along, p->height});
  return out;
}

}  // namespace blockrand::roofs
