// The file configs/surroundings.toml: what grounds are made of, how wide streets are where no tag tells, what objects look like.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/model/surroundings.h"

namespace blockrand::surroundings {

/// The value of a tag of one object, or empty.
using TagOf = std::function<std::string_view(std::string_view key)>;

/// m; measures of a class of streets where no tag tells.
struct StreetDefaults {
  double lane = 3;            ///< width of a lane
  double width = 5.5;         ///< of the carriageway, without parking lanes
  double pavement = 2;        ///< on each side in built-up land; 0: none
  bool kerbed = true;         ///< lies lower than what is beside it
  bool built_up_only = true;  ///< pavements only where houses stand around
  std::string material;       ///< name
};

/// What a tag places: a row of [[object]].
struct ObjectRule {
  std::string key;
  std::vector<std::string> values;  ///< empty: any
  std::string kind;                 ///< of the shapes; empty: not modelled, and told so
  bool node = true, area = true;    ///< of points; in the middle of areas
  std::string also_key;             ///< a second tag that it must have; empty: none
  std::vector<std::string> also_values;
};

/// How grounds look and which tags mean them: a row of [[ground]]; the first row that fits counts.
struct GroundRule {
  std::string key;
  std::vector<std::string> values;  ///< empty: any
  model::GroundClass ground = model::GroundClass::land;
  std::string material;          ///< where `surface` does not tell
  double trees_per_hectare = 0;  ///< that stand in it where none is mapped
  std::string also_key;          ///< a second tag that it must have; empty: none
  std::vector<std::string> also_values;
  bool none = false;    ///< such areas have no ground of their own: ground_of() is null
  bool kerbed = false;  ///< lies lower than what is beside it, as carriageways do
};

/// When a shape is the one that is meant among those of its kind.
struct ShapeTags {
  std::vector<std::pair<std::string, std::vector<std::string>>> tags;  ///< key and values: one of them is enough
  bool by_height = true;                                               ///< a tagged height alone may mean it
  /// m in the shape's frame: how far across its front, to both sides alike, and how high it holds wires.
  std::vector<std::pair<double, double>> wires;
};

class Catalogue {
 public:
  /// \throws base::InputError  missing, not TOML, unknown key, a name that is not there: file, line, column, remedy
  explicit Catalogue(const std::string& path);

  const model::SurroundingCatalogue& shown() const { return shown_; }
  const std::string& sha256() const { return sha256_; }  ///< of the file

  /// \return the row of a material. Names come from the file and from code: an unknown one is a mistake there (asserts in tests,
  /// the first row otherwise)
  model::SurroundingMaterial material(std::string_view name) const;
  /// The material that a value of `surface` means; nothing for unknown ones.
  std::optional<model::SurroundingMaterial> surface(std::string_view value) const;
  /// The defaults of a value of `highway`: those of "other" for unknown ones.
  const StreetDefaults& street(std::string_view highway) const;
  /// Whether vehicles keep to the left at a place in degrees: it lies in a place of `left_hand_traffic`.
  bool keeps_left(model::Location place) const;
  /// The first rule that fits an area's tags; null: none does.
  const GroundRule* ground_of(const TagOf& tag) const;
  /// The first rule that fits an object's tags; null: none does. \param area  the object is an area
  const ObjectRule* object_of(const TagOf& tag, bool area) const;
  /// Shapes of a kind, in the order of the file; empty for unknown ones.
  const std::vector<std::uint16_t>& shapes_of(std::string_view kind) const;
  const ShapeTags& tags_of(std::uint16_t shape) const { return shape_tags_[shape]; }
  /// Where a shape holds wires: across and up.
  const std::vector<std::pair<double, double>>& wires_of(std::uint16_t shape) const { return shape_tags_[shape].wires; }

 private:
  model::SurroundingCatalogue shown_;
  std::string sha256_;
  std::map<std::string, model::SurroundingMaterial, std::less<>> materials_, surfaces_;
  std::map<std::string, StreetDefaults, std::less<>> streets_;
  std::vector<std::vector<model::Point2>> left_hand_;  ///< rings in degrees
  std::vector<GroundRule> grounds_;
  std::vector<ObjectRule> objects_;
  std::map<std::string, std::vector<std::uint16_t>, std::less<>> shapes_;
  std::vector<ShapeTags> shape_tags_;  ///< parallel to the shapes
};

/// A shape and its measures for an object, chosen by its tags: the species and height of a tree, the kind of a lamp.
struct ChosenShape {
  std::uint16_t shape = 0;
  float width = 1, height = 1;  ///< factors of the shape's own measures
  std::optional<double> turn;   ///< rad from east, where `direction` tells
};
/// \param kind    as ObjectRule::kind
/// \param random  in [0, 1) by name of the choice: the same for the same object, whatever else there is
ChosenShape choose_shape(const Catalogue& catalogue, std::string_view kind, const TagOf& tag,
                         const std::function<double(std::string_view choice)>& random);

}  // namespace blockrand::surroundings
