// Drawings in the page: metres on paper. Internal to this folder.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "pipeline/compare/comparison_report.h"

namespace blockrand::compare {

/// Metres to pixels of a drawing, y upwards in metres and downwards in pixels.
struct Sheet {
  double left = 0, top = 0;  ///< m: what lies in the drawing's upper left corner
  double scale = 1;          ///< pixels per metre
  double x(double metres) const { return (metres - left) * scale; }
  double y(double metres) const { return (top - metres) * scale; }
};

/// Appends a pixel coordinate with at most one decimal.
void append_pixel(std::string& out, double value);
/// Appends a closed ring as path data; corners that a pixel would not show are left out.
void append_ring(std::string& out, std::span<const Point2> ring, const Sheet& sheet);

/// A bar of a round length (1, 2, 5 × 10ⁿ m), at most `widest` pixels, its left end at (x, y).
std::string scale_bar(const Sheet& sheet, double widest, double x, double y);

/// Both outlines one over the other, north up. Empty where neither side has a footprint.
/// \param width  pixels
std::string plan_drawing(const Comparison& comparison, const MatchResult& match, int width, int height);

/// The main facades: the reference's and the model's in one plane, the largest first, what is left out last and grey.
/// Empty where no side has a facade.
std::string elevation_drawings(const MatchResult& match, int width);

/// Why a pair of facades takes no part in what is counted: "blank", "party wall"; empty if it does.
std::string_view left_out_because(const FacadePair& pair, const FacadeComparison& facades);

}  // namespace blockrand::compare
