// The rule files of the presets, read once before anything is built.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "styles/districts/rule_set.h"
#include "styles/elements/element_catalogue.h"
#include "styles/grammar/evaluation/derive.h"
#include "styles/grammar/language/check.h"

namespace blockrand::facades {

/// `blockrand.paint("wall", "storey", 2, "colour", "#rrggbb", "material", "brick")`: how the wall looks where the shape is; empty texts
/// leave it as it is. The storey names the layer.
inline constexpr std::string_view kPaintOperation = "paint";

/// What our own operations are called in rule files: `blockrand.window("double_casement", "head", "segmental")`. The
/// first argument is a kind of the catalogue, pairs of parameter and value follow: those of the kind, and
/// colours of parts ("frame_colour", "#f6f6f6"; see model::ElementPart).
///
/// `window` and `door` stand in an opening of the shape's size; `element` stands on the wall.
std::vector<grammar::ExtensionOperation> extension_operations(const elements::ElementCatalogue& catalogue);

/// Which rule file a preset runs, and with which attribute values.
struct PresetGrammar {
  std::string preset;
  std::string file;  ///< below the folder of grammars
  std::vector<std::pair<std::string, std::string>> attributes;
  std::string roof_file{};  ///< the same, what stands on its roof; empty: no dormers, cross gables, ornamental gables
  std::string beside{};  ///< folder that is looked into first: that of the rule set which declares the preset; or empty
  std::optional<bool> on_footprint{};  ///< its rules begin on the footprint; none: as the name of their start rule says
};

/// The grammars of all presets. Immutable once made; used by all threads.
class GrammarLibrary {
 public:
  struct Entry {
    std::string preset;
    std::string file;  ///< below the folder of grammars
    const grammar::Deriver* deriver = nullptr;
    bool on_footprint = false;    ///< its rules begin on the footprint of a part, not on its walls
    bool makes_geometry = false;  ///< its rules make more than elements and bare pieces of the wall (rule_geometry.h)
    bool roof_makes_geometry = false;
    const grammar::Deriver* roof = nullptr;                          ///< of the rules for roofs; null: there are none
    std::vector<std::pair<std::string, grammar::Value>> attributes;  ///< of both
  };

  /// Reads each file once. \param folder  of the rule files; imports are looked for there as well
  /// \throws base::InputError  with all errors of the first file that has some, each with file, line and column
  GrammarLibrary(const std::string& folder, std::span<const PresetGrammar> presets,
                 elements::ElementCatalogue elements);
  ~GrammarLibrary();
  GrammarLibrary(GrammarLibrary&&) noexcept;

  /// The kinds that rules may order.
  const elements::ElementCatalogue& elements() const { return elements_; }
  /// Null when the preset has no grammar.
  const Entry* find(std::string_view preset) const;
  /// Whether a rule file of the preset has an attribute of that name, or one of any preset's does.
  static bool reads(const Entry& entry, const std::string& parameter);
  bool any_reads(const std::string& parameter) const { return read_.contains(parameter); }
  const std::vector<Entry>& entries() const { return entries_; }
  bool empty() const { return entries_.empty(); }
  /// Paths of all files that were read, imports included, by name.
  std::vector<std::string> files() const;
  /// Those of one preset; none when it has no grammar.
  std::vector<std::string> files_of(std::string_view preset) const;

 private:
  struct File;
  elements::ElementCatalogue elements_;
  std::vector<std::unique_ptr<File>> files_;
  std::vector<Entry> entries_;               ///< by name
  std::set<std::string, std::less<>> read_;  ///< names of attributes of all files, as parameters name them
};

/// The rule files of a rule book's presets, from configs/grammars, with the elements and profiles of configs and of the folders in
/// which rule sets declare presets.
/// \param reader  of models that element files name
/// \throws base::InputError  with the errors of a file
GrammarLibrary read_grammars(const std::string& configs, std::span<const districts::Preset> presets,
                             const elements::ModelReader& reader);

/// Parameters of district rules and of presets that nothing reads, one sentence each with its place: PARAMETER_UNREAD.
std::vector<std::string> unread_parameters(const districts::RuleSets& book, const GrammarLibrary& grammars);

}  // namespace blockrand::facades
