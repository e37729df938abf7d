// Facade rules as the rule XML of Bilke (2009) says them: what the reader hands to the translation into rule text.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace blockrand::model {

/// What a rule puts into a piece of facade. A name that ends with ".wrl" is a piece of geometry, any other a symbol.
struct FacadeSymbol {
  std::string name;
  double size = 1;  ///< m, or a share when `relative`
  bool relative = false;
  bool has_size = false;
  std::string property;                            ///< the variable that the size is multiplied by; empty: none
  std::string texture;                             ///< below the folder of textures; empty: inherited
  std::optional<std::array<double, 2>> uv;         ///< size of a tile as a share of the piece, right and up
  std::optional<std::array<double, 3>> scale;      ///< width, height, depth
  std::optional<std::array<double, 3>> translate;  ///< m: right, up, forward
  std::string depth_scale;                         ///< `z_scale`: none, right, up, average; empty: inherited
  std::int64_t line = 0;
};

enum class FacadeRuleKind : std::uint8_t { substitution, split, repeat };

/// One way to replace a symbol.
struct FacadeRuleBranch {
  double probability = 1;
  FacadeRuleKind kind = FacadeRuleKind::substitution;
  bool up = false;       ///< the axis of split and repeat: up, otherwise right
  double size = 1;       ///< repeat: m
  std::string property;  ///< repeat: multiplies the size
  std::vector<FacadeSymbol> symbols;
  std::int64_t line = 0;
};

struct FacadeRule {
  std::string predecessor;
  std::vector<FacadeRuleBranch> branches;
  std::int64_t line = 0;
};

/// A variable that the file sets.
struct FacadeSetting {
  std::string name, value;
  std::int64_t line = 0;
};

struct FacadeRules {
  std::string file;  ///< as messages call it
  std::string name;  ///< of the rule set
  std::vector<FacadeRule> rules;
  std::vector<FacadeSetting> settings;
};

}  // namespace blockrand::model
