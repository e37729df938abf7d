#include "styles/grammar/language/bilke_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "pipeline/base/text.h"
#include "styles/grammar/language/names.h"

namespace blockrand::grammar {

namespace {

using model::FacadeRule;
using model::FacadeRuleBranch;
using model::FacadeRuleKind;
using model::FacadeRules;
using model::FacadeSymbol;

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

bool is_piece(std::string_view name) { return lower(name).ends_with(".wrl"); }

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out + "\"";
}

struct Default {
  const char* name;
  double value;
  bool from_thesis;
};
/// Ours keep the constraints of bilke.md §5.5: cellar windows under ground-floor windows, doors inside their tiles.
constexpr Default kDefaults[] = {
    {"BuildingHeight", 15, true},
    {"FloorHeight", 3, true},
    {"RoofHeight", 4, true},
    {"GroundfloorHeight", 4.2, false},
    {"TopFloorHeight", 3, false},
    {"TileWidth", 3, false},
    {"EntranceTileWidth", 3.6, false},
    {"EntranceColumnWidth", 3, false},
    {"EntranceWidth", 2, false},
    {"EntranceHeight", 3.2, false},
    {"GroundfloorWindowWidth", 1.2, false},
    {"FassadenelementBreite", 3, false},
};

/// Rules that the thesis uses and never prints (§5.9): what stands for them, if that is there.
struct Supplied {
  const char* name;
  const char* by;
  bool up;               ///< axis of the repeat
  const char* property;  ///< nullptr: the symbol itself stands for it
};
constexpr Supplied kSupplied[] = {
    {"FloorTiles", "FloorTileChoice", false, nullptr},
    {"GroundfloorTiles", "GroundfloorTile", false, "TileWidth"},
    {"BackFacadeBalconyTiles", "BackFacadeBalconyTile", true, "FloorHeight"},
};

class Translation {
 public:
  explicit Translation(const FacadeRules& rules) : rules_(rules) {}

  ImportedRules run() {
    for (const FacadeRule& rule : rules_.rules) rule_names_.insert(rule.predecessor);
    collect();
    supply();
    name_everything();
    std::string body;
    for (const FacadeRule& rule : rules_.rules) body += text_of(rule);
    for (const FacadeRule& rule : supplied_) body += text_of(rule);
    for (const std::string& name : undefined_) body += identifier(name) + " --> NIL\n";
    if (!undefined_.empty()) body += "\n";
    for (const std::string& piece : pieces_)
      body += fmt::format("{} --> s('1, '1, pieceDepth({})) i({}) scaleUV(0, 1 / uvRight, 1 / uvUp)\n",
                          identifier(piece), in_quotes(piece), in_quotes(piece));
    return {header() + body, std::move(notes_)};
  }

 private:
  void note(std::int64_t line, const std::string& what) {
    notes_.push_back(fmt::format("{}:{}: {}", rules_.file, line, what));
  }

  // ---- What there is.

  void collect_branch(const FacadeRuleBranch& branch) {
    if (!branch.property.empty()) variable(branch.property, branch.line);
    for (const FacadeSymbol& symbol : branch.symbols) {
      if (!symbol.property.empty()) variable(symbol.property, symbol.line);
      if (is_piece(symbol.name)) {
        if (std::find(pieces_.begin(), pieces_.end(), symbol.name) == pieces_.end()) pieces_.push_back(symbol.name);
        continue;
      }
      produced_.insert(symbol.name);
      if (rule_names_.count(symbol.name) == 0) missing_.try_emplace(symbol.name, symbol.line);
    }
  }

  void collect() {
    for (const model::FacadeSetting& setting : rules_.settings) {
      const std::string key = lower(setting.name);
      if (variables_.count(key) == 0) order_.push_back(key);
      double value = 0;
      const char* end = setting.value.data() + setting.value.size();
      const auto read = std::from_chars(setting.value.data(), end, value);
      const bool number = read.ec == std::errc{} && read.ptr == end && std::isfinite(value);
      variables_[key] = {setting.name, number ? base::shortest(value) : in_quotes(setting.value), number};
    }
    for (const FacadeRule& rule : rules_.rules)
      for (const FacadeRuleBranch& branch : rule.branches) collect_branch(branch);
  }

  struct Variable {
    std::string name, value;
    bool number = true;
  };

  void variable(const std::string& name, std::int64_t line) {
    const std::string key = lower(name);
    if (const auto known = variables_.find(key); known != variables_.end()) {
      if (known->second.name != name && spellings_.insert(name).second)
        note(line, fmt::format("variable '{}' is also written '{}'; both are taken for one", known->second.name, name));
      if (!known->second.number) {
        note(line, fmt::format("variable '{}' is no number, but sizes are multiplied by it; 1 is used", name));
        known->second.value = "1";
        known->second.number = true;
      }
      return;
    }
    order_.push_back(key);
    for (const Default& d : kDefaults) {
      if (lower(d.name) != key) continue;
      variables_[key] = {name, base::shortest(d.value), true};
      if (!d.from_thesis)
        note(line, fmt::format("variable '{}' has no value in the file; {} m is used", name, base::shortest(d.value)));
      return;
    }
    variables_[key] = {name, "1", true};
    note(line, fmt::format("variable '{}' has no value in the file and no known default; 1 m is used", name));
  }

  void supply() {
    for (const auto& [name, line] : missing_) {
      const auto* found = std::find_if(std::begin(kSupplied), std::end(kSupplied), [&, n = &name](const Supplied& s) {
        return *n == s.name && rule_names_.count(s.by) > 0;
      });
      if (found == std::end(kSupplied)) {
        undefined_.push_back(name);
        note(line, fmt::format("symbol '{}' has no rule: nothing is built there", name));
        continue;
      }
      FacadeRule rule;
      rule.predecessor = name;
      rule.line = line;
      FacadeRuleBranch branch;
      branch.line = line;
      if (found->property != nullptr) {
        branch.kind = FacadeRuleKind::repeat;
        branch.up = found->up;
        branch.property = found->property;
      }
      FacadeSymbol symbol;
      symbol.name = found->by;
      symbol.line = line;
      branch.symbols.push_back(symbol);
      rule.branches.push_back(branch);
      collect_branch(branch);
      supplied_.push_back(std::move(rule));
      note(line, fmt::format("symbol '{}' has no rule; '{}' stands for it", name, found->by));
    }
  }

  // ---- Names.

  /// Letters, digits and underscores; different from all names given before and from those of the language.
  void give_name(const std::string& name, std::string wanted) {
    for (char& c : wanted)
      if (std::isalnum(static_cast<unsigned char>(c)) == 0 || static_cast<unsigned char>(c) > 127) c = '_';
    if (wanted.empty() || std::isdigit(static_cast<unsigned char>(wanted.front())) != 0) wanted = "Rule" + wanted;
    const auto taken = [&](const std::string& candidate) {
      for (const NameKind kind : {NameKind::operation, NameKind::keyword, NameKind::function, NameKind::attribute})
        if (find_built_in(kind, candidate) != nullptr) return true;
      return identifiers_taken_.count(candidate) > 0;
    };
    std::string candidate = wanted;
    for (int i = 2; taken(candidate); ++i) candidate = wanted + "_" + std::to_string(i);
    identifiers_taken_.insert(candidate);
    identifiers_[name] = candidate;
  }

  void name_everything() {
    for (const char* own : {"zScale", "depthScale", "uvRight", "uvUp", "pieceDepth", "fitting", "piecesIn"})
      identifiers_taken_.insert(own);
    for (const std::string& key : order_) give_name("variable " + key, variables_[key].name);
    for (const FacadeRule& rule : rules_.rules) give_name(rule.predecessor, rule.predecessor);
    for (const FacadeRule& rule : supplied_) give_name(rule.predecessor, rule.predecessor);
    for (const std::string& name : undefined_) give_name(name, name);
    for (const std::string& piece : pieces_) {
      const std::size_t slash = piece.find_last_of("/\\");
      std::string stem = piece.substr(slash == std::string::npos ? 0 : slash + 1);
      stem.resize(stem.size() - 4);
      give_name(piece, stem + "Piece");
    }
  }

  const std::string& identifier(const std::string& name) const { return identifiers_.at(name); }
  std::string variable_name(const std::string& property) const {
    return identifiers_.at("variable " + lower(property));
  }

  // ---- Text.

  std::string header() const {
    std::string name;
    for (const char c : rules_.name) name += static_cast<unsigned char>(c) < 32 ? ' ' : c;
    std::string text = "version \"2025.0\"\n// Facade rules" + (name.empty() ? "" : " \"" + name + "\"") +
                       ", translated from the rule XML of Bilke's CityGenerator.\n\n";
    for (const std::string& key : order_) {
      const Variable& v = variables_.at(key);
      text += "attr " + variable_name(v.name) + " = " + v.value + "\n";
    }
    return text +
           "\n// What pieces inherit: how their depth follows width and height, how deep, and how large a tile of "
           "texture is.\n"
           "@Hidden attr zScale = \"average\"\n@Hidden attr depthScale = 1\n@Hidden attr uvRight = 1\n@Hidden attr "
           "uvUp = 1\n\n"
           "pieceDepth(file) =\n"
           "  case zScale == \"none\" : depthScale * assetInfo(file, sz)\n"
           "  case zScale == \"right\" : depthScale * assetInfo(file, sz) * scope.sx / assetInfo(file, sx)\n"
           "  case zScale == \"up\" : depthScale * assetInfo(file, sz) * scope.sy / assetInfo(file, sy)\n"
           "  else : depthScale * assetInfo(file, sz) * (scope.sx / assetInfo(file, sx) + scope.sy / assetInfo(file, "
           "sy)) / 2\n"
           "// What sizes in metres are multiplied by, so that together they are no longer than the whole.\n"
           "fitting(whole, sizes) = case sizes > whole && whole > 0 : whole / sizes else : 1\n"
           "// How many pieces of a size fit whole.\n"
           "piecesIn(whole, size) = case size > 0 : max(1, floor(whole / size + 0.000001)) else : 1\n\n";
  }

  std::string length(double size, const std::string& property) const {
    if (property.empty()) return base::shortest(size);
    return size == 1 ? variable_name(property) : base::shortest(size) + " * " + variable_name(property);
  }

  /// A symbol in its scope.
  std::string text_of(const FacadeSymbol& symbol) const {
    std::string steps;
    const std::array<double, 3> scale = symbol.scale.value_or(std::array<double, 3>{1, 1, 1});
    if (scale[0] != 1 || scale[1] != 1)
      steps += fmt::format("s('{}, '{}, '1) center(x) ", base::shortest(scale[0]), base::shortest(scale[1]));
    if (symbol.translate)
      steps += fmt::format("t({}, {}, {}) ", base::shortest((*symbol.translate)[0]),
                           base::shortest((*symbol.translate)[1]), base::shortest((*symbol.translate)[2]));
    if (scale[2] != 1) steps += fmt::format("set(depthScale, depthScale * {}) ", base::shortest(scale[2]));
    if (!symbol.depth_scale.empty()) steps += fmt::format("set(zScale, {}) ", in_quotes(symbol.depth_scale));
    if (!symbol.texture.empty()) steps += fmt::format("texture({}) ", in_quotes(symbol.texture));
    // (1, 1) means inherited (§4.8).
    if (symbol.uv && *symbol.uv != std::array<double, 2>{1, 1})
      steps += fmt::format("set(uvRight, {}) set(uvUp, {}) ", base::shortest((*symbol.uv)[0]),
                           base::shortest((*symbol.uv)[1]));
    return steps + identifier(symbol.name);
  }

  std::string text_of(const FacadeRuleBranch& branch) const {
    const std::string axis = branch.up ? "y" : "x";
    std::string text;
    switch (branch.kind) {
      case FacadeRuleKind::substitution:
        for (const FacadeSymbol& symbol : branch.symbols) {
          const std::string one = text_of(symbol);
          // Changes of one symbol's scope are not the next one's.
          text += (text.empty() ? "" : " ") + (one.find(' ') == std::string::npos ? one : "[ " + one + " ]");
        }
        return text;
      case FacadeRuleKind::repeat:
        return fmt::format("split({0}){{ ~(scope.s{0} / piecesIn(scope.s{0}, {1})) : {2} }}*", axis,
                           length(branch.size, branch.property), text_of(branch.symbols.front()));
      case FacadeRuleKind::split:
        break;
    }
    std::string sum;
    for (const FacadeSymbol& symbol : branch.symbols)
      if (!symbol.relative) sum += (sum.empty() ? "" : " + ") + length(symbol.size, symbol.property);
    for (const FacadeSymbol& symbol : branch.symbols) {
      text += text.empty() ? "" : " | ";
      text += symbol.relative
                  ? "~" + base::shortest(symbol.size)
                  : fmt::format("{} * fitting(scope.s{}, {})", length(symbol.size, symbol.property), axis, sum);
      text += " : " + text_of(symbol);
    }
    return fmt::format("split({}){{ {} }}", axis, text);
  }

  std::string text_of(const FacadeRule& rule) {
    std::string text;
    if (produced_.count(rule.predecessor) == 0) text += "@StartRule\n";
    double sum = 0;
    for (const FacadeRuleBranch& branch : rule.branches) sum += branch.probability;
    if (rule.branches.size() == 1)
      return text + identifier(rule.predecessor) + " -->\n  " + text_of(rule.branches.front()) + "\n\n";
    if (sum <= 0)
      note(rule.line, fmt::format("the probabilities of '{}' are all 0; all branches get the same", rule.predecessor));
    // Thirds are printed as 0.333333.
    constexpr double kTolerance = 1e-5;
    if (sum > 0 && std::abs(sum - 1) > kTolerance)
      note(rule.line, fmt::format("the probabilities of '{}' sum to {}; they are divided by that", rule.predecessor,
                                  base::shortest(sum)));
    text += "@Consistent(\"building\")\n" + identifier(rule.predecessor) + " -->\n";
    for (std::size_t i = 0; i < rule.branches.size(); ++i) {
      const double share =
          sum > 0 ? rule.branches[i].probability / sum : 1.0 / static_cast<double>(rule.branches.size());
      const std::string percent = base::shortest(std::round(share * 1e8) / 1e6);
      text += i + 1 < rule.branches.size() ? "  " + percent + "% : " : "  else : ";
      text += text_of(rule.branches[i]) + "\n";
    }
    return text + "\n";
  }

  const FacadeRules& rules_;
  std::vector<std::string> notes_;
  std::set<std::string> rule_names_, produced_, spellings_, identifiers_taken_;
  std::map<std::string, std::int64_t> missing_;  ///< symbols without rule, with the line of their first use
  std::vector<std::string> undefined_, pieces_, order_;
  std::vector<FacadeRule> supplied_;
  std::map<std::string, Variable> variables_;  ///< by name in lower case
  std::map<std::string, std::string> identifiers_;
};

}  // namespace

ImportedRules rule_text_of(const FacadeRules& rules) { return Translation(rules).run(); }

}  // namespace blockrand::grammar
