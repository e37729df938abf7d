// The main facades of a match: both models' walls and openings in one plane.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pipeline/base/portable_math.h"
#include "pipeline/compare/report_numbers.h"
#include "pipeline/compare/report_svg.h"
#include "pipeline/geometry/polygon_measures.h"

namespace blockrand::compare {
namespace {

constexpr std::size_t kMostFacades = 4;
constexpr double kWorthDrawing = 0.12;                // share of the largest facade's area
constexpr double kLargestScale = 20, kTallest = 240;  // pixels per metre; pixels

/// From a facade's own coordinates to those of the plane that is drawn.
struct Along {
  double offset = 0, factor = 1;
  double operator()(double x) const { return offset + factor * x; }
};

Along along(const Facade& from, const Facade& plane) {
  const double px = plane.right.x - plane.left.x, py = plane.right.y - plane.left.y;
  const double fx = from.right.x - from.left.x, fy = from.right.y - from.left.y;
  const double width = std::sqrt(px * px + py * py), own = std::sqrt(fx * fx + fy * fy);
  if (!(width > 0) || !(own > 0)) return {};
  return {((from.left.x - plane.left.x) * px + (from.left.y - plane.left.y) * py) / width,
          (fx * px + fy * py) / (width * own)};
}

std::string_view compass(const Facade& f) {
  static constexpr std::array<std::string_view, 8> kNames{"north", "north-east", "east", "south-east",
                                                          "south", "south-west", "west", "north-west"};
  const double dx = f.right.x - f.left.x, dy = f.right.y - f.left.y;
  const double azimuth = base::atan2(dy, -dx) * base::kDegreesPerRadian;
  return kNames[static_cast<std::size_t>(static_cast<int>(std::floor((azimuth + 360 + 22.5) / 45)) % 8)];
}

struct Box {
  double left = std::numeric_limits<double>::max(), right = std::numeric_limits<double>::lowest(), top = 0, bottom = 0;
  bool empty() const { return left > right; }
  void include(const Facade& f, Along place) {
    const auto at = [&](double x, double y) {
      if (!std::isfinite(x) || !std::isfinite(y)) return;
      left = std::min(left, place(x));
      right = std::max(right, place(x));
      top = std::max(top, y);
      bottom = std::min(bottom, y);
    };
    at(0, f.bottom);
    at(f.width(), f.top);
    for (const Rings3& rings : f.outline)
      for (const auto& ring : rings)
        for (const Point3& p : ring) at(p.x, p.y);
    for (const FacadeOpening& o : f.openings) {
      at(o.left, o.bottom);
      at(o.right, o.top);
    }
  }
};

/// All walls as one path: outer rings one way round and holes the other, so that overlapping walls make one area.
void append_walls(std::string& out, const Facade& f, Along place, const Sheet& sheet, std::string_view style) {
  std::string path;
  for (const Rings3& rings : f.outline)
    for (std::size_t r = 0; r < rings.size(); ++r) {
      std::vector<Point2> ring;
      for (const Point3& p : rings[r]) ring.push_back({place(p.x), p.y});
      if (ring.size() < 3) continue;
      if ((geometry::signed_area(ring) > 0) != (r == 0)) std::reverse(ring.begin(), ring.end());
      append_ring(path, ring, sheet);
    }
  if (path.empty()) {
    const std::array<Point2, 4> box{
        {{place(0), f.bottom}, {place(f.width()), f.bottom}, {place(f.width()), f.top}, {place(0), f.top}}};
    append_ring(path, box, sheet);
  }
  out += fmt::format("<path class=\"{}\" d=\"{}\"/>", style, path);
}

void append_openings(std::string& out, const Facade& f, Along place, const Sheet& sheet, std::string_view style) {
  std::string path;
  for (const FacadeOpening& o : f.openings) {
    const std::array<Point2, 4> box{
        {{place(o.left), o.bottom}, {place(o.right), o.bottom}, {place(o.right), o.top}, {place(o.left), o.top}}};
    append_ring(path, box, sheet);
  }
  if (!path.empty()) out += fmt::format("<path class=\"{}\" d=\"{}\"/>", style, path);
}

std::string counts(const Facade* reference, const Facade* model, int Facade::*member) {
  return (reference ? std::to_string(reference->*member) : "–") + " / " +
         (model ? std::to_string(model->*member) : "–");
}

std::string drawing(const MatchResult& match, const FacadePair& pair, int width) {
  const Facade* const reference =
      pair.reference < match.facades.reference.size() ? &match.facades.reference[pair.reference] : nullptr;
  const Facade* const model = pair.model < match.facades.model.size() ? &match.facades.model[pair.model] : nullptr;
  const Facade& plane = reference ? *reference : *model;
  const Along model_place = model ? along(*model, plane) : Along{};
  Box box;
  if (reference) box.include(*reference, {});
  if (model) box.include(*model, model_place);
  if (box.empty()) return {};

  constexpr double kMargin = 6, kFoot = 20;
  const double wide = std::max(0.5, box.right - box.left), high = std::max(0.5, box.top - box.bottom);
  Sheet sheet;
  sheet.scale = std::min({(width - 2 * kMargin) / wide, kTallest / high, kLargestScale});
  sheet.left = box.left - kMargin / sheet.scale;
  sheet.top = box.top + kMargin / sheet.scale;
  const int w = std::max(120, static_cast<int>(std::ceil(wide * sheet.scale + 2 * kMargin)));
  const int h = static_cast<int>(std::ceil(high * sheet.scale + kMargin + kFoot));
  const std::string_view left_out = left_out_because(pair, match.facades);

  std::string out = fmt::format(
      "<figure class=\"elevation{}\" style=\"width: {}px\"><svg viewBox=\"0 0 {} {}\" width=\"{}\" height=\"{}\" "
      "role=\"img\" "
      "aria-label=\"Facade to the {}\">",
      left_out.empty() ? "" : " out", w + 2, w, h, w, h, compass(plane));
  if (reference) append_walls(out, *reference, {}, sheet, "r w");
  if (model) append_walls(out, *model, model_place, sheet, "m w");
  if (reference) append_openings(out, *reference, {}, sheet, "r o");
  if (model) append_openings(out, *model, model_place, sheet, "m o");
  std::string ticks;
  if (reference)
    for (const auto& [ours, theirs] : pair.matches) {
      if (theirs >= reference->openings.size()) continue;
      const FacadeOpening& o = reference->openings[theirs];
      ticks += 'M';
      append_pixel(ticks, sheet.x((o.left + o.right) / 2));
      ticks += ' ';
      append_pixel(ticks, sheet.y((o.bottom + o.top) / 2));
      ticks += "h0";
    }
  if (!ticks.empty()) out += "<path class=\"dot\" d=\"" + ticks + "\"/>";
  out += "<path class=\"earth\" d=\"M0 ";
  append_pixel(out, sheet.y(0));
  out += "h" + std::to_string(w) + "\"/>";
  out += scale_bar(sheet, w / 3.0, kMargin, h - 5);
  out += "</svg><figcaption>";
  out += fmt::format("Facade to the {}, {}\u00a0m wide", compass(plane), fixed(plane.width(), 1));
  if (!left_out.empty()) {
    out += fmt::format(": <b>left out: {}</b>", left_out);
  } else if (reference == nullptr) {
    out += ": in the model only";
  } else if (model == nullptr) {
    out += ": in the reference only";
  }
  const std::size_t theirs = reference ? reference->openings.size() : 0, ours = model ? model->openings.size() : 0;
  if (theirs + ours > 0)
    out += fmt::format(". Openings {} / {}, {} matched; storeys {}; axes {}", reference ? std::to_string(theirs) : "–",
                       model ? std::to_string(ours) : "–", pair.matches.size(),
                       counts(reference, model, &Facade::storeys), counts(reference, model, &Facade::axes));
  return out + "</figcaption></figure>";
}

}  // namespace

std::string_view left_out_because(const FacadePair& pair, const FacadeComparison& facades) {
  if (!pair.left_out) return "";
  return pair.reference < facades.reference.size() && facades.reference[pair.reference].blank ? "blank" : "party wall";
}

std::string elevation_drawings(const MatchResult& match, int width) {
  const FacadeComparison& f = match.facades;
  const auto area = [&](const FacadePair& p) {
    return std::max(p.reference < f.reference.size() ? f.reference[p.reference].area : 0,
                    p.model < f.model.size() ? f.model[p.model].area : 0);
  };
  double largest = 0;
  std::vector<const FacadePair*> drawn;
  for (const FacadePair& p : f.pairs) {
    if (p.reference >= f.reference.size() && p.model >= f.model.size()) continue;
    largest = std::max(largest, area(p));
    drawn.push_back(&p);
  }
  std::erase_if(drawn, [&](const FacadePair* p) { return area(*p) < largest * kWorthDrawing; });
  // Facades that both have, then those of one model, then what is left out.
  const auto rank = [&](const FacadePair* p) {
    if (p->left_out) return 2;
    return p->reference >= f.reference.size() || p->model >= f.model.size() ? 1 : 0;
  };
  std::stable_sort(drawn.begin(), drawn.end(), [&](const FacadePair* a, const FacadePair* b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : area(*a) > area(*b);
  });
  std::string out;
  for (std::size_t i = 0; i < std::min(drawn.size(), kMostFacades); ++i) out += drawing(match, *drawn[i], width);
  if (!out.empty() && f.pairs.size() > kMostFacades)
    out += fmt::format("<p class=\"soft small\">{} of {} facades are drawn.</p>", std::min(drawn.size(), kMostFacades),
                       f.pairs.size());
  return out;
}

}  // namespace blockrand::compare
