// All kinds of elements: those of the program and those of element files, with the profiles they use.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "pipeline/model/triangle_model.h"
#include "styles/elements/element_kind.h"
#include "styles/elements/profile_library.h"

namespace blockrand::elements {

/// Reads a model that an element file names. \throws base::InputError
using ModelReader = std::function<model::TriangleModel(const std::string& path)>;

/// An element that may be simpler than what was asked for.
struct FittedElement {
  Element element;
  std::string told;  ///< what was asked for and why it cannot be made; empty where it was
};

/// Who made what an element file holds, and under which terms it may be used.
struct ElementCredit {
  std::string kind;
  std::string licence, source, author;  ///< empty where the file says nothing; models say the first two
};

/// Constant once it is read: threads may share it. A copy is cheap and shares all of it.
class ElementCatalogue {
 public:
  /// Without files: the built-in kinds, and no profile.
  ElementCatalogue();

  /// Every kind: the built-in ones in the order of docs/elements.md, then those of files by name. They live as long as
  /// the catalogue or a copy of it.
  std::span<const ElementKind> kinds() const;
  /// Null when there is none of that name.
  const ElementKind* find(std::string_view name) const;
  /// Mouldings by name.
  const ProfileLibrary& profiles() const;
  /// All files that were read, models too, in the order of reading: what is kept of elements depends on them.
  std::span<const std::string> files() const;
  /// Of the files that say something of it, by the kind's name.
  std::span<const ElementCredit> credits() const;

  /// Why an element of a file's kind is no sound one, as a rule asked for it; empty for sound ones and for built-in kinds.
  std::string defect_of(const Element& element, double width, double height) const;

  /// Makes an element. Pure: the same arguments give the same bytes.
  ///
  /// \param width, height  m, what they measure is in ElementKind
  /// \param parameters     those that are not named keep their defaults
  /// Error: unknown kinds, parameters and words, each with the nearest known; values out of range, with the range;
  /// sizes that leave no room for what is asked for.
  tl::expected<Element, std::string> make(std::string_view kind, double width, double height,
                                          std::span<const Parameter> parameters = {}) const;

  /// The same for rules that do not know every limit, so that one measure costs no more than itself: where an element
  /// cannot be made as asked, sizes above their range get its end, numbers out of range their nearest, angles out of
  /// range their default; where that does not do, what it may lack is left off as well (doors of shop windows,
  /// pediments, bars).
  /// Error: as make() as asked, where all of that leaves nothing: unknown names, sizes below their range.
  tl::expected<FittedElement, std::string> make_fitting(std::string_view kind, double width, double height,
                                                        std::span<const Parameter> parameters = {}) const;

 private:
  struct Data;
  explicit ElementCatalogue(std::shared_ptr<const Data> data);
  friend ElementCatalogue read_element_catalogue(std::span<const std::string> folders, const ModelReader& reader);
  std::shared_ptr<const Data> data_;  ///< null in what was moved from, which may be assigned to alone
};

/// Reads profiles and element files: of each folder `profiles/*.toml`, then `elements/*.toml`, by name. Either may be
/// absent. A profile or kind of a later folder replaces one of the same name of an earlier one, but no built-in kind.
/// docs/element_files.md says what stands in the files. Each kind is made at its least, usual and most
/// size.
///
/// \param reader  for files that name a model; without one these are errors
/// \throws base::InputError  with file, place and remedy: what cannot be read, unknown keys and names, kinds that
///         cannot be made, or are no sound elements
ElementCatalogue read_element_catalogue(std::span<const std::string> folders, const ModelReader& reader = {});

}  // namespace blockrand::elements
