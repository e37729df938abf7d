// The features of the group `tag`: what a mapper noted of a building, as numbers.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/extract.h"
#include "styles/classify/features.h"
#include "styles/classify/tag_lookup.h"

namespace blockrand::classify {

/// A roof shape as one of the values of Feature::tag_roof.
int roof_kind(model::RoofShape shape);

/// Tables of configs/styles/tags.toml.
struct TagTables {
  std::map<std::string, int, std::less<>> use;           ///< building=* → value of Feature::tag_use
  std::map<std::string, int, std::less<>> architecture;  ///< building:architecture=* → year
  std::vector<std::string> listed, known;                ///< keys: of lists of monuments; of what is written about
  std::vector<std::string> attached;                     ///< sub-styles that stand in rows and pairs only
  /// Sub-styles built for one kind of use (ids of the catalogue), by the value of Feature::tag_use.
  std::map<int, std::vector<std::string>> styles_of_use;
  /// \throws base::InputError with file, line and column
  static TagTables read(const std::string& path);
  int use_of(std::string_view building_value) const;
};

/// Fills the features of the group `tag`.
void fill_tag_features(FeatureVector& features, const model::MappedAttributes& attributes, std::string_view use,
                       const TagLookup& tag, const TagTables& tables);

}  // namespace blockrand::classify
