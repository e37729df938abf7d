// The elements of a region: each form made once, each colouring listed once.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/model/region.h"
#include "styles/elements/element_catalogue.h"
#include "styles/grammar/evaluation/derive.h"

namespace blockrand::facades {

/// Looks of all parts of an element, by model::ElementPart.
using PartMaterials = std::array<model::PartMaterial, model::kElementPartCount>;

class ElementLibrary {
 public:
  /// \param region  gets the elements; must outlive this
  ElementLibrary(model::Region& region, const attributes::Defaults& defaults, elements::ElementCatalogue catalogue);

  static constexpr std::uint32_t kNone = 0xffffffff;
  /// Sizes are whole centimetres, rounded down, so that equal elements are one.
  static double size(double metres);
  /// Width and height that an element gets in a room: those of openings are multiples of 5 and 10 cm, rounded down.
  static std::pair<double, double> size(const elements::ElementKind* kind, double width, double height);

  /// What parts look like that no rule says: wall and its trim as the building, the rest as usual.
  PartMaterials usual_materials(const model::BuildingPart& part) const;

  /// Begins a request.
  void ask(std::string_view kind, double width, double height, const PartMaterials& materials);
  /// A parameter of elements::ElementCatalogue::make; the last one of a name that is given twice is an error there.
  void add(const std::string& name, std::string_view word);
  void add(const std::string& name, double number);
  /// All parameters of an order in a rule file: pairs of name and value after the kind; "PART_colour" colours a part.
  /// \param keep_left, keep_right  false: not the run's own end, but one beside an interruption, cut square
  /// \param complaints  gets what is no colour
  void add_request(const grammar::ElementRequest& order, bool keep_left, bool keep_right,
                   std::vector<std::string>& complaints);
  /// The number of the element asked for in Region::elements; kNone when it cannot be made, for the reason in `error`. Where
  /// a simpler one was made, `error` says so.
  std::uint32_t take(std::string& error);

  /// The number of an element that rules made themselves: equal ones are one.
  std::uint32_t add_made(model::Element&& element, const PartMaterials& materials);

  /// All elements of another library, in their order, as if they had been asked for here. \param other  has nothing left
  /// \return  number here by number there
  std::vector<std::uint32_t> take_over(ElementLibrary& other);

  const model::Element& element(std::uint32_t number) const { return *region_.elements[number].element; }
  const PartMaterials& materials(std::uint32_t number) const { return region_.elements[number].materials; }

 private:
  struct Made {
    std::shared_ptr<const model::Element> element;
    std::string error;
    std::array<bool, model::kElementPartCount> parts{};  ///< has faces of it
    std::vector<std::pair<PartMaterials, std::uint32_t>> coloured;
  };
  using Entry = std::pair<const std::string, Made>;  ///< by its key
  std::uint32_t number_of(Entry& entry, const PartMaterials& materials);
  void add_key(char type, std::string_view text);
  void add_key(double value, double steps);

  model::Region& region_;
  elements::ElementCatalogue catalogue_;
  std::uint8_t plaster_ = 0, wood_ = 0, glass_ = 0, metal_ = 0;
  // The request: its key is what was asked for, byte by byte.
  std::string kind_, key_;
  double width_ = 0, height_ = 0;
  PartMaterials materials_of_parts_;
  std::vector<elements::Parameter> parameters_;
  std::unordered_map<std::string, Made> made_;
  std::vector<Entry*> of_number_;  ///< parallel to Region::elements
};

}  // namespace blockrand::facades
