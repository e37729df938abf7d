// explain/places.tsv: where each explained building stands and how people name it.
//
// One line per building, sorted by object like explain/index.txt; seven fields, separated by tabs, without a heading:
//
//   w123  15_35206_25947  13.4013389  52.5375952  24.6  Arkonaplatz 5, 10435 Berlin; Swinemünder Straße 12  Café Mila
//
//   id of the building · tile · longitude, latitude: the middle of the mapped outline, degrees, 7 decimals · height of its top
//   above the ground, m, 1 decimal, 0.0 of one without a body · addresses · name
//
// The building's own address comes first, as "address" of its explanation; then, behind "; ", each house number that points
// inside of it add: entrances and address nodes, with their own street, else the building's, else the one that wall looks at.
// Addresses and names are empty where none are mapped. Tabs, line ends and other control characters in them are spaces.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "pipeline/model/region.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {

inline constexpr const char* kPlacesFile = "explain/places.tsv";

/// A line of the file.
struct Place {
  std::string id, tile;
  double lon = 0, lat = 0;  ///< degrees
  double top = 0;           ///< m above the ground; 0 without a body
  std::string addresses, name;
};

/// \returns empty for what is no such line. \param line  without its end
std::optional<Place> read_place(std::string_view line);

/// With its end.
std::string place_line(const Place& place);

/// Gathers a building's addresses as the file has them.
class AddressList {
 public:
  /// \param line  "Arkonaplatz 5, 10435 Berlin" \param street, numbers  of it: "Arkonaplatz", "5;7"; all may be empty
  AddressList(std::string_view line, std::string_view street, std::string_view numbers);
  /// A house number at a wall. \param own_street  of the point that has it; \param wall_street  that the wall looks at
  void add(std::string_view number, std::string_view own_street, std::string_view wall_street);
  const std::string& text() const { return text_; }

 private:
  std::string_view street_, numbers_;
  std::string text_;
};

/// addr:street, else addr:place of a mapped point; empty where it has neither.
std::string_view street_of_point(const model::Extract& extract, model::OsmId point);

/// m above the ground of the highest body; 0 without one.
double top_of(const model::Building& building);

/// The addresses of a building of `region`.
std::string addresses_of(const model::Region& region, const TagReader& tags, const model::Building& building);

}  // namespace blockrand::outputs
