// Runs a program on a shape: attributes first, then rules level by level, until only leaves are left
// (docs/rule_language.md §4).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "styles/grammar/evaluation/functions.h"
#include "styles/grammar/language/program.h"
#include "styles/grammar/language/source.h"
#include "styles/grammar/language/value.h"
#include "styles/grammar/shapes/shape.h"

namespace blockrand::grammar {

/// Where a derivation stops (docs/rule_language.md §4.2). What is beyond is told with its place and left out; the rest
/// is kept.
struct DeriveLimits {
  std::size_t shapes = 100000;          ///< shapes with a symbol, of all levels
  std::uint32_t depth = 1024;           ///< from the start rule down
  std::uint32_t function_depth = 1024;  ///< of functions that call functions
  std::size_t pieces = 1000000;         ///< of blocks, with symbols or without
  /// Calls of the file's own functions, and tests of a surface against another for context queries: so that none runs
  /// for hours.
  std::size_t calls = 10000000;
  std::size_t diagnostics = 1000;  ///< told; further ones are counted only
  std::size_t faces = 100000;      ///< of one shape: operations on more are left out
};

/// Read-only values about the building that the shape belongs to, by name: "building.storeys", "edge.kind",
/// "storey.use", "roof.shape"; "edgeAttr.NAME" for the edge attribute functions. nullopt: there is no such value.
/// Each name is asked once a derivation at most.
using AttributeSource = std::function<std::optional<Value>(std::string_view name)>;

/// Values of attributes that derivations share: those that depend on nothing of a single derivation, neither on its shape nor on its seed nor
/// on values that are its own. The first derivation that needs one puts it here. For one thread, one program, and equal `attributes` and seeds of
/// building and row.
struct AttributeMemo {
  std::vector<std::optional<Value>> values;  ///< by slot of the program; grows by itself
};

struct DeriveOptions {
  std::string start_rule;  ///< without parameters; empty: the program's
  std::uint64_t seed = 0;
  /// What `@Consistent("building")` and `@Consistent("row")` draw from (docs/rule_language.md §4.3): equal in all
  /// derivations of a building and of a row of houses.
  std::uint64_t building_seed = 0, row_seed = 0;
  /// Attribute values from outside, by qualified name ("h", "roof.h"); ":" in a name counts as "__"
  /// (docs/rule_language.md §4.1). Texts are turned into the attribute's type. Values that the program gives
  /// ("building.storeys") may stand here, too.
  std::vector<std::pair<std::string, Value>> attributes;
  AttributeSource source;
  AttributeMemo* memo = nullptr;  ///< null: all attributes are evaluated
  bool (*is_shared)(std::string_view name) =
      nullptr;  ///< of a name that `source` knows: all that share the memo get the same value
  const FileAccess* files = nullptr;
  std::string shape_name;  ///< `initialShape.name`
  DeriveLimits limits;
  bool keep_tree = false;  ///< fill Derivation::tree
  /// Only leaves with orders and what is told are wanted: no other leaves, no values of attributes, no notes of unused ones.
  bool orders_only = false;
  /// Deriver::outside_values() of `attributes`, where somebody has them ready; else they are looked for.
  const std::vector<std::uint32_t>* outside = nullptr;
  /// For tests: a name of the language that does nothing. Operations leave the shape as it is, functions and attributes
  /// have the default value of their type, selectors choose nothing. What holds with the name and not without it is
  /// the name's own work (docs/grammar_features.md).
  const BuiltIn* without = nullptr;
};

/// `blockrand.NAME(arguments…)`: what to put where the leaf's shape is.
struct ElementRequest {
  std::string name;  ///< without the prefix
  std::vector<Value> arguments;
  Location location;
};

/// A shape that no rule works on any more: what the model consists of.
struct Leaf {
  std::string symbol;
  Shape shape;
  std::shared_ptr<const ElementRequest> order;  ///< of blockrand.* operations; else null
  std::uint32_t node = 0;  ///< in Derivation::tree: itself when it has a symbol of its own, else the rule's shape
  Location location;       ///< of the step that made it; of the rule for shapes that are left over
};

/// A shape with a symbol. The tree's first node is the initial shape.
struct TreeNode {
  std::uint32_t parent = kNone;
  std::uint32_t ordinal = 0;  ///< among its parent's children
  std::uint32_t depth = 0;
  std::string symbol;
  std::uint32_t definition = kNone;  ///< the rule that worked on it; kNone: a leaf
  Location location;                 ///< of the step that made it
  Shape shape;                       ///< as the rule found it; with DeriveOptions::keep_tree only
};

/// `report(key, value)` summed up by key and type.
struct Report {
  std::string key;
  Type type = Type::number;
  std::size_t count = 0;
  double sum = 0, mean = 0, minimum = 0, maximum = 0;  ///< numbers; truth values count as 0 and 1; texts: 0
};

struct Derivation {
  std::vector<Leaf> leaves;     ///< in the order in which they came about: level by level
  std::vector<TreeNode> tree;   ///< empty unless asked for
  std::vector<Report> reports;  ///< ordered by key, then type
  std::vector<std::string> prints;
  std::vector<std::pair<std::string, Value>> attributes;  ///< values after the attribute phase, by qualified name
  std::vector<Diagnostic> diagnostics;
  std::size_t shapes = 0;  ///< with a symbol
  std::size_t untold = 0;  ///< diagnostics beyond the limit

  /// The report of a key; nullptr where there is none.
  const Report* report(std::string_view key) const;
};

/// A program made ready to run; may be used by several threads at once. The program must outlive it.
class Deriver {
 public:
  explicit Deriver(const Program& program);
  ~Deriver();
  Deriver(Deriver&&) noexcept;
  Derivation run(const Shape& initial, const DeriveOptions& options = {}) const;
  /// By slot of the program: which of the attributes from outside gives its value; kNone: none.
  std::vector<std::uint32_t> outside_values(const std::vector<std::pair<std::string, Value>>& attributes) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

/// For a single derivation.
Derivation derive(const Program& program, const Shape& initial, const DeriveOptions& options = {});

/// "0;1;3;": the way from the root to a node (docs/rule_language.md §3.2, getTreeKey).
std::string tree_key(const Derivation& derivation, std::uint32_t node);

}  // namespace blockrand::grammar
