// Reads element files.
#include "styles/elements/element_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "pipeline/base/error.h"
#include "pipeline/base/text.h"
#include "styles/elements/kinds.h"

namespace blockrand::elements {
namespace {

using Type = ParameterInfo::Type;

/// m. The widest and highest kinds are courses and stacks of stones.
constexpr double kLeastSize = 0.02, kMostSize = 320;
constexpr std::size_t kMostParameters = 50;

bool is_opening(const ElementKind& kind) { return kind.semantic != ElementClass::installation; }

bool is_number(const ParameterInfo& info) { return info.type == Type::number || info.type == Type::whole; }

/// A text that must be there and say something.
std::string required_text(base::TomlTable& table, const char* key, const char* remedy) {
  auto text = table.text(key);
  if (!text || text->empty()) table.fail(key, "is missing", remedy);
  return *text;
}

void read_size(base::TomlTable& table, const char* key, bool required, SizeRange& size) {
  const auto values = table.numbers(key);
  if (!values && !required) return;
  if (!values || values->size() != 3 ||
      !((*values)[0] >= kLeastSize && (*values)[0] <= (*values)[1] && (*values)[1] <= (*values)[2] &&
        (*values)[2] <= kMostSize))
    table.fail(key, "wants three rising numbers in metres: least, usual, most",
               fmt::format("For example {} = [0.6, 1.1, 2.0]", key));
  if (!required && ((*values)[0] < size.least || (*values)[2] > size.most))
    table.fail(key, "reaches beyond its base's",
               fmt::format("That goes from {} to {} m", base::shortest(size.least), base::shortest(size.most)));
  size.least = (*values)[0];
  size.usual = (*values)[1];
  size.most = (*values)[2];
}

ParameterInfo detail_parameter() {
  return {.name = "detail",
          .type = Type::whole,
          .initial = 1,
          .least = 0,
          .most = 2,
          .meaning = "0: flat, for far away; 1: usual; 2: all sides, strips and curves"};
}

ParameterInfo read_parameter(base::TomlTable& table, const ElementKind& kind) {
  ParameterInfo info;
  info.name = required_text(table, "name", kSeePage);
  if (!is_free_name(info.name) || info.name == "detail")
    table.fail("name", fmt::format("cannot be \"{}\"", info.name),
               "Letters, digits and _; w, h, i, n, min, max and detail have their meaning");
  for (const ParameterInfo& other : kind.parameters)
    if (other.name == info.name) table.fail("name", fmt::format("\"{}\" is there already", info.name), "Rename one");
  info.unit = table.text("unit").value_or("");
  info.type = table.boolean("whole").value_or(false) ? Type::whole : Type::number;
  const auto range = table.numbers("range");
  if (!range || range->size() != 2 || !((*range)[0] <= (*range)[1]))
    table.fail("range", "wants two rising numbers", "For example range = [0.02, 0.3]");
  info.least = (*range)[0];
  info.most = (*range)[1];
  const auto initial = table.number("default", info.least, info.most);
  if (!initial) table.fail("default", "is missing", "Give a number in the range");
  info.initial = *initial;
  for (const double v : {info.least, info.most, info.initial})
    if (info.type == Type::whole && v != std::floor(v))
      table.fail("whole", "wants whole numbers", "Write them without a point");
  info.meaning = required_text(table, "meaning", "Say what the parameter is");
  table.finish();
  return info;
}

/// Other defaults of a base's parameters: what a rule could give.
void read_defaults(base::TomlTable& file, ElementKind& kind, const ProfileLibrary& profiles) {
  auto table = file.table("defaults");
  if (!table) return;
  for (const std::string& key : table->keys()) {
    Parameter given{key, 0.0};
    if (table->holds_text(key))
      given.value = *table->text(key);
    else if (table->holds_boolean(key))
      given.value = std::string(*table->boolean(key) ? "yes" : "no");
    else if (table->holds_number(key))
      given.value = *table->number(key, -1e9, 1e9);
    else
      table->fail(key, "must be a number or a word", kSeePage);
    if (const auto checked = Values::check(kind, std::span(&given, 1), profiles); !checked)
      table->fail(key, checked.error(), "docs/elements.md has the parameters of each kind");
    for (ParameterInfo& info : kind.parameters) {
      if (info.name != key) continue;
      if (const double* const number = std::get_if<double>(&given.value))
        info.initial = *number;
      else if (const std::string& text = std::get<std::string>(given.value); info.type == Type::word)
        info.initial = static_cast<double>(std::find(info.words.begin(), info.words.end(), text) - info.words.begin());
      else
        info.words = {text};
    }
  }
}

void read_base(base::TomlTable& table, const ProfileLibrary& profiles, ElementFile& out) {
  const std::string name = *table.text("base"), own = out.kind.name, meaning = out.kind.meaning;
  const auto kinds = built_in_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const ElementKind& k) { return k.name == name; });
  if (found == kinds.end()) {
    std::vector<std::string> known;
    for (const ElementKind& k : kinds) known.push_back(k.name);
    const std::string near = base::nearest(name, known);
    table.fail("base", fmt::format("\"{}\" is no built-in element", name),
               near.empty() ? "docs/elements.md has them all" : fmt::format("Did you mean \"{}\"?", near));
  }
  out.kind = *found;
  out.kind.name = own;
  out.kind.meaning = meaning;
  out.base_kind = name;
  out.base = generators()[static_cast<std::size_t>(found - kinds.begin())];
  read_size(table, "width", false, out.kind.width);
  read_size(table, "height", false, out.kind.height);
  read_defaults(table, out.kind, profiles);
}

void read_own(base::TomlTable& table, ElementFile& out) {
  const auto semantic = table.text("class");
  if (semantic == "window")
    out.kind.semantic = ElementClass::window;
  else if (semantic == "door")
    out.kind.semantic = ElementClass::door;
  else if (semantic == "installation")
    out.kind.semantic = ElementClass::installation;
  else
    table.fail("class", semantic ? fmt::format("cannot be \"{}\"", *semantic) : "is missing",
               "Write class = \"window\", \"door\" or \"installation\"");
  out.kind.width.measures = out.kind.height.measures = is_opening(out.kind) ? "opening" : "whole";
  if (table.boolean("run").value_or(false)) {
    if (is_opening(out.kind)) table.fail("run", "cannot be true of an opening", "Leave it out");
    out.kind.width.measures = "run";
  }
  read_size(table, "width", true, out.kind.width);
  read_size(table, "height", true, out.kind.height);
  for (base::TomlTable& parameter : table.tables("parameter")) {
    if (out.kind.parameters.size() >= kMostParameters) table.fail("parameter", "stands too often", kSeePage);
    out.kind.parameters.push_back(read_parameter(parameter, out.kind));
  }
  out.kind.parameters.push_back(detail_parameter());
}

/// The names that expressions know, and the opening.
void read_opening(base::TomlTable& table, ElementFile& out) {
  out.names = {"w", "h"};
  bool reveal_is_parameter = false;
  for (const ParameterInfo& info : out.kind.parameters) {
    if (!is_number(info)) continue;
    out.names.push_back(info.name);
    reveal_is_parameter |= info.name == "reveal";
  }
  if (out.base || !is_opening(out.kind)) return;
  if (reveal_is_parameter) {
    if (table.has("reveal")) table.fail("reveal", "is a parameter already", "Leave one of them out");
  } else {
    // A model may bring its own depth.
    const bool flush = table.has("model") && !table.has("reveal");
    out.reveal = flush ? Expression(0.0) : read_expression(table, "reveal", out.names);
    out.names.push_back("reveal");
  }
  if (table.has("outline")) {
    out.outline = read_places(table, "outline", out.names);
    if (out.outline.size() < 3) table.fail("outline", "wants three corners", kSeePage);
  }
}

}  // namespace

ElementFile parse_element_file(std::string_view text, const std::string& file, const std::string& name,
                               const ProfileLibrary& profiles, const ModelReader& reader) {
  base::TomlTable table = base::TomlTable::parse(text, file);
  ElementFile out;
  out.file = file;
  out.kind.name = name;
  const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  if (name.empty() || !std::all_of(name.begin(), name.end(), fits))
    throw base::InputError(file, "", fmt::format("\"{}\" cannot be the name of an element", name),
                           "Name the file with small letters, digits and _ alone");
  for (const ElementKind& k : built_in_kinds())
    if (k.name == name)
      throw base::InputError(file, "", fmt::format("\"{}\" is a built-in element", name), "Give the file another name");
  out.kind.meaning = required_text(table, "meaning", "Say what the element is");
  if (table.has("base") && table.has("model"))
    table.fail("model", "stands beside base", "A file varies a kind or shows a model");
  if (table.has("base"))
    read_base(table, profiles, out);
  else
    read_own(table, out);
  read_opening(table, out);
  out.licence = table.text("licence").value_or("");
  out.source = table.text("source").value_or("");
  out.author = table.text("author").value_or("");
  if (table.has("model"))
    out.model = read_placed_model(table, std::filesystem::path(file).parent_path().string(), is_opening(out.kind),
                                  reader, out.model_path);
  for (base::TomlTable& piece : table.tables("piece")) {
    if (out.pieces.size() >= kMostPieces)
      table.fail("piece", fmt::format("stands more than {} times", kMostPieces), kSeePage);
    out.pieces.push_back(read_piece(piece, out.names, profiles));
    out.piece_lines.push_back(piece.line());
  }
  if (!out.base && !out.model && out.pieces.empty())
    table.fail("piece", "is missing: the element is made of nothing", "Add a [[piece]], a base or a model");
  table.finish();
  return out;
}

Made make_from_file(const ElementFile& file, const Request& r, Element& element) {
  MeshBuilder builder;
  if (file.base) {
    if (Made made = file.base(r, element); !made) return made;
    if (file.pieces.empty()) return {};
    builder.append(element.mesh);
  }
  std::vector<double> values{r.width, r.height};
  for (const ParameterInfo& info : file.kind.parameters)
    if (is_number(info)) values.push_back(r.values.number(info.name));
  if (!file.base && is_opening(file.kind)) {
    const double reveal = file.reveal ? file.reveal->value(values) : r.values.number("reveal");
    if (!(reveal >= 0 && reveal <= kDeepest))
      return tl::unexpected(
          fmt::format("the reveal is {} m; it goes from 0 to {} m", base::shortest(reveal), kDeepest));
    if (file.reveal) values.push_back(reveal);
    element.opening.reveal = reveal;
    const double half = model::snap(r.width / 2), top = model::snap(r.height);
    if (file.outline.empty()) {
      element.opening.outline = {{-half, 0}, {half, 0}, {half, top}, {-half, top}};
    } else {
      auto outline = places_of(file.outline, values);
      if (!outline) return tl::unexpected("outline: " + outline.error());
      element.opening.outline = std::move(*outline);
    }
  }
  if (file.model) add_model(builder, *file.model, r, element.opening.reveal);
  values.resize(values.size() + 2);
  for (std::size_t k = 0; k < file.pieces.size(); ++k)
    if (Made made = add_piece(builder, file.pieces[k], values, element, r.values); !made)
      return tl::unexpected(fmt::format("piece {} ({}, line {}): {}", k + 1, model::name(file.pieces[k].part),
                                        file.piece_lines[k], made.error()));
  element.mesh = builder.take();
  return {};
}

}  // namespace blockrand::elements
