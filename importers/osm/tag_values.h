// What mappers write into the Simple 3D Buildings keys, as numbers and colours. Pure functions: text in, value out,
// nothing when the text cannot be understood. Surrounding blanks never matter, letters match in either case.
#pragma once

#include <optional>
#include <string_view>

#include "pipeline/model/colour.h"
#include "pipeline/model/roof_shape.h"

namespace blockrand::importers::osm {

/// Which of several numbers counts. A list (`3;4`) or range (`12-14`) says that the building has both: the highest
/// gives its silhouette, the lowest where it begins.
enum class Pick { highest, lowest };

/// A length in metres: `12`, `12 m`, `12m`, `1,5`, `500 cm`, `0.5 km`, `40'`, `40'6"`, `40 ft`, `40 ft 6 in`, with or
/// without a leading `~`, `ca.`, `<`, `>`; lists and ranges as `pick` says. May be negative: limits are the caller's.
std::optional<double> parse_length(std::string_view text, Pick pick = Pick::highest);

/// A number of storeys: `3`, `2.5`, `1,5`, `2½`, `3;4`, `3-4`, `~5`; no unit.
std::optional<double> parse_storeys(std::string_view text, Pick pick = Pick::highest);

/// An inclination in degrees: `30`, `30°`, `30 deg`, `37,5`.
std::optional<double> parse_angle(std::string_view text);

/// A direction in degrees clockwise from north, in [0, 360): `45`, `45°`, `-90`, `NNE`, `north`, `south-west`.
std::optional<double> parse_direction(std::string_view text);

/// `#a33`, `#aa3333` (a fourth component, opacity, is ignored), `aa3333`, `rgb(1,2,3)`, and the 148 colour names of CSS
/// with or without blanks, hyphens and underscores (`dark red`, `light-grey`). Of a list the first counts.
std::optional<model::Colour> parse_colour(std::string_view text);
/// Whether parse_colour() reads a word ("red"), not numbers.
bool is_colour_word(std::string_view text);

/// A name of the scheme in either spelling (`half-hipped`, `half_hipped`) or a common synonym (`gable`, `hip`, `shed`);
/// of a list the first. Any other non-empty text is RoofShape::other.
std::optional<model::RoofShape> parse_roof_shape(std::string_view text);

/// `along` or `across`.
std::optional<model::RoofOrientation> parse_roof_orientation(std::string_view text);

/// One of CSS's colour names, in lower case without blanks, hyphens and underscores.
std::optional<model::Colour> colour_of_name(std::string_view name);

}  // namespace blockrand::importers::osm
