// A user's corrections, kept beside the data and keyed by OSM id: overrides.toml. The file is described in
// docs/districts.md.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/model/detail_override.h"
#include "pipeline/model/region.h"

namespace blockrand::classify {
class Catalogue;
}

namespace blockrand::context {
struct BuildingGround;
}

namespace blockrand::attributes {

struct OverrideValue {
  std::variant<double, std::string, model::RoofShape, model::RoofOrientation, model::Colour> value;
  int line = 0;
};

/// A model by somebody else that is to stand for a building.
struct OverrideModel {
  std::string file;  ///< as the entry names it
  std::string path;  ///< of the file: beside the overrides
  std::string source, licence;
  std::string author;  ///< may be empty
  /// Of glTF, which lies nowhere: longitude and latitude of its origin; none: the middle of the outline.
  std::optional<std::array<double, 2>> at;
  double turn = 0;     ///< degrees clockwise seen from above, about its origin; of glTF
  double scale = 1;    ///< of glTF
  double lift = 0;     ///< m of its lowest point above the ground
  std::string sha256;  ///< of the file
  int line = 0;
};

/// What is ordered for one building or part.
struct OverrideEntry {
  model::OsmId object;    ///< the part where there is one
  model::OsmId building;  ///< under which the entry stands
  int line = 0;
  std::map<std::string, OverrideValue> values;  ///< by the name of the attribute (model::for_each_attribute)
  std::vector<model::DetailOverride> details;
  model::SidePitches side_pitches;     ///< roof_pitches, of single sides of the roof
  std::optional<OverrideModel> model;  ///< of whole buildings
  bool keeps_place = false;            ///< imagery = "off": no image moves the building, or those in the area
  model::MappedAttributes tagged;      ///< what the tags said before, once applied
  std::vector<std::string> conflicts;  ///< tags that gave way because orders contradict them, in words
  bool is_part() const { return !(object == building); }
  const double* number(const std::string& attribute) const;
  const std::string* text(const std::string& attribute) const;
};

struct Overrides {
  std::string file;                    ///< as given
  std::string name;                    ///< of the file, without folders: what evidence says
  std::vector<OverrideEntry> entries;  ///< by object, each once
  const OverrideEntry* find(model::OsmId object) const;
};

/// Names that values are checked against; an empty list checks nothing.
struct OverrideNames {
  std::vector<std::string> presets, substyles;
};

/// \throws base::InputError  with file, line and column: not TOML, keys that are no id and no attribute, values out of
///                           range, unknown names (with the nearest), values that contradict each other
Overrides read_overrides(const std::string& path, const Defaults& defaults, const OverrideNames& names);

/// The files of the models that a file of overrides names and that are there; none where it cannot be read: read_overrides() tells why.
std::vector<std::string> models_of(const std::string& overrides);

/// Gives the orders to the extract's objects as if they were tags, before any stage looks at them: what hangs together
/// (storeys, heights, roof) then follows as it follows from tags. Tags that an order contradicts are taken away: a
/// height for a storey height, other measures of the roof for one of them, and of heights, undersides, roofs and
/// storeys those that leave storeys of less than 1.5 or more than 20 m (OverrideEntry::conflicts). What the tags said
/// stays in OverrideEntry::tagged. Entries whose object is not there, is no building or is not built are told in
/// `report` as OVERRIDE_UNMATCHED.
void apply_overrides(Overrides& overrides, model::Extract& extract, model::Report& report);

/// What is assumed of a building, but for the storey height that is ordered. \param storage  holds it
const UseDefaults& with_overrides(const OverrideEntry* entry, const UseDefaults& usual, UseDefaults& storage);
/// Puts the ordered ground and plinth in the place of what the terrain says.
void override_ground(const OverrideEntry* entry, context::BuildingGround& ground);

/// After everything else about a building is decided: ordered values get the source `override`, confidence 1 and the
/// place in the file as evidence; the tag that lost stands first among what lost. Attributes that no other depends on
/// (style, preset ...) get their value here, in the building's parts, too, where nothing else is ordered for those. An
/// ordered value that could not be met keeps the source of what was stronger and is told as VALUES_CONFLICT, as are
/// tags that gave way. What follows from orders is `implied`, not `tag`. With a catalogue an ordered sub-style brings
/// its class and era, and an ordered class a sub-style of its own. Details go to Building::detail_overrides; those for
/// a storey or an edge that is not there, and orders for parts under another building than theirs (which hold), are
/// told as OVERRIDE_UNMATCHED.
void mark_overrides(model::Region& region, const Overrides& overrides, const classify::Catalogue* catalogue = nullptr);

}  // namespace blockrand::attributes
