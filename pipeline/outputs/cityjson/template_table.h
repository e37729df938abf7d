// Elements as geometry templates of a CityJSON file: each distinct one once.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "pipeline/model/region.h"
#include "pipeline/outputs/material_classes.h"

namespace blockrand::outputs {

/// What stands for elements that no template is made of.
inline constexpr std::uint32_t kNoTemplate = 0xffffffff;

/// A template is a MultiSurface of LoD 3 in the frame of CityGML's implicit geometries: x along the wall, y into it, z
/// up; metres with four decimals. Keeps the text of all templates, about a kilobyte each.
class TemplateTable {
 public:
  /// \param materials  of the file's appearance, to which templates refer
  explicit TemplateTable(MaterialNumbers& materials) : materials_(materials) {}

  /// The numbers of the templates of a region's elements, by element; kNoTemplate for those that no written part of
  /// LoD3 places. Material classes are numbered by `class_of`.
  std::vector<std::uint32_t> add(const model::Region& region, const std::vector<std::uint8_t>& class_of);

  bool empty() const { return numbers_.empty(); }
  /// The value of "geometry-templates".
  void append(std::string& out) const;

 private:
  std::uint32_t number(const model::ColouredElement& element, const std::vector<std::uint8_t>& class_of);

  MaterialNumbers& materials_;
  std::unordered_map<std::string, std::uint32_t> numbers_;  ///< by vertices, faces and materials; looked up only
  std::string templates_, vertices_;
  std::uint32_t vertex_count_ = 0;
};

}  // namespace blockrand::outputs
