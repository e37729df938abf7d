// Coordinates and values as GML writes them. Internal to this folder.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::importers::reference {

std::string_view trimmed(std::string_view text);

/// The number that the whole text is, without regard to the locale; "+" before it is allowed. Nothing for any other
/// text and for what is not finite.
std::optional<double> number_of(std::string_view text);

/// A whole number, also written as "4.0".
std::optional<int> whole_number_of(std::string_view text);

/// The year that a gYear or date starts with: "1998", "1998+01:00", "1998-05-17".
std::optional<int> year_of(std::string_view text);

/// All numbers of a list separated by white space; nothing when one is none.
std::optional<std::vector<double>> numbers_of(std::string_view text);

/// gml:coordinates → numbers_of's form. Empty separators are the standard's: "." "," " ".
std::string as_number_list(std::string_view text, const std::string& decimal, const std::string& within,
                           const std::string& between);

/// Points of a list of numbers.
/// \param dimension  as stated, 2 or 3; 0: not stated, then 3 unless only 2 divides or closes the list
/// \return nothing when the count does not fit; `two_dimensional` tells whether z was left out
struct PointList {
  std::vector<model::Point3> points;
  bool two_dimensional = false;
};
std::optional<PointList> points_of(const std::vector<double>& numbers, int dimension);

}  // namespace blockrand::importers::reference
