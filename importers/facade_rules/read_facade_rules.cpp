#include "importers/facade_rules/read_facade_rules.h"

#include <libxml/parser.h>
#include <libxml/tree.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"

namespace blockrand::importers::facade_rules {

namespace {

/// Rule files measure some kilobytes; what is larger is something else.
constexpr std::size_t kLargestFile = 64U << 20U;

struct FreeDocument {
  void operator()(xmlDoc* document) const { xmlFreeDoc(document); }
};

std::string_view name_of(const xmlNode* node) { return reinterpret_cast<const char*>(node->name); }

class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  model::FacadeRules read(std::string_view xml) {
    if (xml.size() > kLargestFile)
      throw base::InputError(file_, "", "larger than 64 MB", "Is this a file of facade rules?");
    const std::unique_ptr<xmlDoc, FreeDocument> document(
        xmlReadMemory(xml.data(), static_cast<int>(xml.size()), file_.c_str(), nullptr,
                      XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_BIG_LINES));
    if (!document) {
      const xmlError* error = xmlGetLastError();
      std::string what = error != nullptr && error->message != nullptr ? error->message : "no XML";
      while (!what.empty() && (what.back() == '\n' || what.back() == '.')) what.pop_back();
      throw base::InputError(file_, error != nullptr ? std::to_string(error->line) : "", "not valid XML: " + what, "");
    }
    const xmlNode* root = xmlDocGetRootElement(document.get());
    if (root == nullptr || name_of(root) != "Rulefile")
      fail(root, "the outermost element must be 'Rulefile'",
           "This reads facade rules as Bilke's CityGenerator writes them");
    rules_.file = file_;
    for_attributes(root, {"name"}, [&](std::string_view, const std::string& value) { rules_.name = value; });
    for_elements(root, {"Rule", "BuildingSettings"}, [&](const xmlNode* node) {
      if (name_of(node) == "Rule")
        rule(node);
      else
        settings(node);
    });
    if (rules_.rules.empty()) fail(root, "no rule", "");
    return std::move(rules_);
  }

 private:
  [[noreturn]] void fail(const xmlNode* node, const std::string& what, const std::string& remedy) const {
    throw base::InputError(file_, node != nullptr ? std::to_string(xmlGetLineNo(node)) : "", what, remedy);
  }

  [[noreturn]] void fail_unknown(const xmlNode* node, const std::string& what, std::string_view name,
                                 const std::vector<std::string>& known) const {
    const std::string near = base::nearest(name, known);
    std::string list;
    for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
    fail(node, what + " '" + std::string(name) + "'",
         near.empty() ? "Known are: " + (list.empty() ? "none" : list) : "Did you mean '" + near + "'?");
  }

  template <typename F>
  void for_elements(const xmlNode* parent, const std::vector<std::string>& known, F what) const {
    for (const xmlNode* node = parent->children; node != nullptr; node = node->next) {
      if (node->type == XML_TEXT_NODE && !without_blanks(node).empty())
        fail(parent, "text '" + without_blanks(node).substr(0, 40) + "' where only elements can stand", "");
      if (node->type == XML_ENTITY_REF_NODE) fail(parent, "entities are not read here", "");
      if (node->type != XML_ELEMENT_NODE) continue;
      if (std::find(known.begin(), known.end(), name_of(node)) == known.end())
        fail_unknown(node, "unknown element", name_of(node), known);
      what(node);
    }
  }

  /// Attributes of other namespaces (xsi:…) are left aside.
  template <typename F>
  void for_attributes(const xmlNode* node, const std::vector<std::string>& known, F what) const {
    for (const xmlAttr* attribute = node->properties; attribute != nullptr; attribute = attribute->next) {
      if (attribute->ns != nullptr) continue;
      const std::string_view name = reinterpret_cast<const char*>(attribute->name);
      if (std::find(known.begin(), known.end(), name) == known.end())
        fail_unknown(node, "unknown attribute", name, known);
      xmlChar* value = xmlNodeListGetString(node->doc, attribute->children, 1);
      const std::string text = value != nullptr ? reinterpret_cast<const char*>(value) : "";
      xmlFree(value);
      what(name, text);
    }
  }

  /// Names are wrapped over lines in printed listings: blanks mean nothing.
  static std::string without_blanks(const xmlNode* node) {
    xmlChar* content = xmlNodeGetContent(node);
    std::string text = content != nullptr ? reinterpret_cast<const char*>(content) : "";
    xmlFree(content);
    std::erase_if(text, [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; });
    return text;
  }

  std::vector<double> numbers(const xmlNode* node, std::string_view text, std::string_view what,
                              std::size_t count) const {
    std::vector<double> all;
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    while (true) {
      while (at != end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r' || *at == ',')) ++at;
      if (at == end) break;
      if (*at == '+') ++at;
      double value = 0;
      const auto [next, error] = std::from_chars(at, end, value);
      if (error != std::errc{} || !std::isfinite(value)) all.resize(count + 1);
      if (all.size() > count) break;
      all.push_back(value);
      at = next;
    }
    if (all.size() != count)
      fail(node,
           std::string(what) + "=\"" + std::string(text) + "\" is not " +
               (count == 1 ? "a number" : std::to_string(count) + " numbers"),
           "");
    return all;
  }
  double number(const xmlNode* node, std::string_view text, std::string_view what) const {
    return numbers(node, text, what, 1)[0];
  }
  template <std::size_t N>
  std::array<double, N> tuple(const xmlNode* node, std::string_view text, std::string_view what) const {
    const std::vector<double> all = numbers(node, text, what, N);
    std::array<double, N> values{};
    std::copy(all.begin(), all.end(), values.begin());
    return values;
  }

  bool is_up(const xmlNode* node, const std::string& axis) const {
    if (axis != "r" && axis != "u") fail(node, "axis=\"" + axis + "\"", "Axes are 'r' (right) and 'u' (up)");
    return axis == "u";
  }

  void settings(const xmlNode* parent) {
    for (const xmlNode* node = parent->children; node != nullptr; node = node->next)
      if (node->type == XML_ELEMENT_NODE)
        rules_.settings.push_back({std::string(name_of(node)), without_blanks(node), xmlGetLineNo(node)});
  }

  void rule(const xmlNode* node) {
    model::FacadeRule rule;
    rule.line = xmlGetLineNo(node);
    for_attributes(node, {}, [](std::string_view, const std::string&) {});
    for_elements(node, {"Predecessor", "Rules"}, [&](const xmlNode* child) {
      if (name_of(child) == "Predecessor") {
        rule.predecessor = without_blanks(child);
        return;
      }
      for_elements(child, {"Probability"}, [&](const xmlNode* b) { rule.branches.push_back(branch(b)); });
    });
    if (rule.predecessor.empty()) fail(node, "a rule without 'Predecessor'", "");
    if (rule.branches.empty()) fail(node, "the rule of '" + rule.predecessor + "' replaces it by nothing", "");
    for (const model::FacadeRule& other : rules_.rules)
      if (other.predecessor == rule.predecessor)
        fail(node,
             "a second rule of '" + rule.predecessor + "'; the first stands in line " + std::to_string(other.line),
             "Write its branches into the first one, or keep it in a file of its own");
    rules_.rules.push_back(std::move(rule));
  }

  model::FacadeRuleBranch branch(const xmlNode* node) {
    model::FacadeRuleBranch branch;
    branch.line = xmlGetLineNo(node);
    for_attributes(node, {"value"}, [&](std::string_view name, const std::string& value) {
      branch.probability = number(node, value, name);
      if (branch.probability < 0) fail(node, "a probability below 0", "");
    });
    bool repeat_size = false;
    for_elements(node, {"Split", "Repeat", "Symbol"}, [&](const xmlNode* child) {
      const std::string_view kind = name_of(child);
      if (kind == "Symbol") {
        branch.symbols.push_back(symbol(child));
        return;
      }
      if (branch.kind != model::FacadeRuleKind::substitution || !branch.symbols.empty())
        fail(child, "'" + std::string(kind) + "' stands once, before the symbols", "");
      bool axis = false;
      if (kind == "Split") {
        branch.kind = model::FacadeRuleKind::split;
        for_attributes(child, {"axis"}, [&](std::string_view, const std::string& value) {
          branch.up = is_up(child, value);
          axis = true;
        });
      } else {
        branch.kind = model::FacadeRuleKind::repeat;
        for_attributes(child, {"axis", "size", "property"}, [&](std::string_view name, const std::string& value) {
          if (name == "axis") branch.up = is_up(child, value);
          if (name == "size") branch.size = number(child, value, name);
          if (name == "property") branch.property = value;
          axis = axis || name == "axis";
          repeat_size = repeat_size || name == "size";
        });
        if (branch.size <= 0) fail(child, "the size of a repeat must be above 0", "");
      }
      if (!axis) fail(child, "'" + std::string(kind) + "' needs an axis", "axis=\"r\" (right) or axis=\"u\" (up)");
    });
    if (branch.symbols.empty()) fail(node, "no symbol", "");
    if (branch.kind == model::FacadeRuleKind::repeat) {
      if (branch.symbols.size() != 1) fail(node, "exactly one symbol follows a repeat", "");
      const model::FacadeSymbol& only = branch.symbols.front();
      if (!repeat_size && (!only.has_size || only.relative || only.size <= 0))
        fail(node, "a repeat without size", "Give 'Repeat' a size in metres");
      if (!repeat_size) branch.size = only.size;
      if (branch.property.empty()) branch.property = only.property;
    }
    return branch;
  }

  model::FacadeSymbol symbol(const xmlNode* node) const {
    model::FacadeSymbol symbol;
    symbol.line = xmlGetLineNo(node);
    symbol.name = without_blanks(node);
    if (symbol.name.empty()) fail(node, "a symbol without name", "");
    for_attributes(node, {"size", "property", "texture", "uv", "scale", "translate", "z_scale"},
                   [&](std::string_view name, const std::string& value) {
                     if (name == "size") {
                       std::string_view digits = value;
                       while (digits.ends_with(' ')) digits.remove_suffix(1);
                       symbol.relative = digits.ends_with('r');
                       if (symbol.relative) digits.remove_suffix(1);
                       symbol.size = number(node, digits, name);
                       symbol.has_size = true;
                       if (symbol.size < 0) fail(node, "a size below 0", "");
                     } else if (name == "property") {
                       symbol.property = value;
                     } else if (name == "texture") {
                       symbol.texture = value;
                     } else if (name == "uv") {
                       symbol.uv = tuple<2>(node, value, name);
                       if ((*symbol.uv)[0] == 0 || (*symbol.uv)[1] == 0) fail(node, "uv must not be 0", "");
                     } else if (name == "scale") {
                       symbol.scale = tuple<3>(node, value, name);
                     } else if (name == "translate") {
                       symbol.translate = tuple<3>(node, value, name);
                     } else {
                       const std::vector<std::string> known = {"none", "right", "up", "average"};
                       if (std::find(known.begin(), known.end(), value) == known.end())
                         fail_unknown(node, "unknown z_scale", value, known);
                       symbol.depth_scale = value;
                     }
                   });
    return symbol;
  }

  std::string file_;
  model::FacadeRules rules_;
};

}  // namespace

model::FacadeRules read_facade_rules(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in) throw base::InputError(path, "", "cannot be read", "");
  return parse_facade_rules(bytes, path);
}

model::FacadeRules parse_facade_rules(std::string_view xml, const std::string& name) { return Reader(name).read(xml); }

}  // namespace blockrand::importers::facade_rules
