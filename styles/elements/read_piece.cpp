// Reads the [[piece]] tables of element files.
#include <fmt/format.h>

#include <algorithm>

#include "styles/elements/element_piece.h"

namespace blockrand::elements {
namespace {

Expression expression_of(const base::TomlTable& table, const char* key, const base::NumberOrText& value,
                         std::span<const std::string> names) {
  if (const double* const number = std::get_if<double>(&value)) return Expression(*number);
  const std::string& text = std::get<std::string>(value);
  auto read = Expression::parse(text, names);
  if (!read) table.fail(key, fmt::format("in \"{}\", {}", text.substr(0, 60), read.error()), kSeePage);
  return *read;
}

Measures read_range(base::TomlTable& table, const char* key, std::span<const std::string> names) {
  const auto values = table.numbers_or_texts(key);
  if (!values || values->size() != 2)
    table.fail(key, "wants two values: [from, to]", fmt::format("For example {} = [0, \"w / 2\"]", key));
  return {expression_of(table, key, (*values)[0], names), expression_of(table, key, (*values)[1], names)};
}

void read_moulding(base::TomlTable& table, std::span<const std::string> names, const ProfileLibrary& profiles,
                   Piece& piece) {
  if (const auto name = table.text("profile")) {
    if (table.has("profile_program")) table.fail("profile_program", "stands beside profile", "Leave one of them out");
    if (!profiles.contains(*name)) {
      std::vector<std::string> known;
      for (const auto& [n, preset] : profiles) known.push_back(n);
      const std::string near = base::nearest(*name, known);
      table.fail("profile", fmt::format("\"{}\" is not there", *name),
                 near.empty() ? "Add it to a folder profiles" : fmt::format("Did you mean \"{}\"?", near));
    }
    piece.profile = *name;
  } else {
    const auto text = table.text("profile_program");
    const auto program = parse_profile(*text);
    if (!program) table.fail("profile_program", "in the program, " + program.error().text(), "See docs/elements.md");
    piece.program = *program;
  }
  piece.points = read_places(table, "along", names);
  if (piece.points.size() < 2) table.fail("along", "wants two points", kSeePage);
  piece.height = read_expression(table, "height", names);
  piece.projection = read_expression(table, "projection", names);
}

void read_form(base::TomlTable& table, std::span<const std::string> names, const ProfileLibrary& profiles,
               Piece& piece) {
  struct Known {
    const char* key;
    Piece::Form form;
  };
  constexpr Known kForms[] = {{"polygon", Piece::Form::polygon},
                              {"section", Piece::Form::section},
                              {"ring", Piece::Form::ring},
                              {"profile", Piece::Form::moulding},
                              {"profile_program", Piece::Form::moulding}};
  const auto found =
      std::find_if(std::begin(kForms), std::end(kForms), [&](const Known& k) { return table.has(k.key); });
  piece.form = found == std::end(kForms) ? Piece::Form::box : found->form;
  switch (piece.form) {
    case Piece::Form::box:
      if (!table.has("x"))
        table.fail("x", "is missing, and so is any other form",
                   "Give x, y and z, or polygon, section, ring or profile");
      piece.x = read_range(table, "x", names);
      piece.y = read_range(table, "y", names);
      piece.z = read_range(table, "z", names);
      break;
    case Piece::Form::polygon:
      piece.points = read_places(table, "polygon", names);
      piece.flat = table.holds_number("z") || table.holds_text("z");
      if (piece.flat)
        piece.z[0] = piece.z[1] = read_expression(table, "z", names);
      else
        piece.z = read_range(table, "z", names);
      break;
    case Piece::Form::section:
      piece.points = read_places(table, "section", names);
      piece.x = read_range(table, "x", names);
      break;
    case Piece::Form::ring:
      if (table.text("ring") != "outline") table.fail("ring", "cannot be that", "Write ring = \"outline\"");
      piece.width = read_expression(table, "width", names);
      piece.z = read_range(table, "z", names);
      break;
    case Piece::Form::moulding:
      read_moulding(table, names, profiles, piece);
      break;
  }
}

}  // namespace

Expression read_expression(base::TomlTable& table, const char* key, std::span<const std::string> names) {
  const auto value = table.number_or_text(key);
  if (!value) table.fail(key, "is missing", kSeePage);
  return expression_of(table, key, *value, names);
}

std::vector<Measures> read_places(base::TomlTable& table, const char* key, std::span<const std::string> names) {
  const auto pairs = table.pairs_of_numbers_or_texts(key);
  if (!pairs) table.fail(key, "is missing", kSeePage);
  if (pairs->size() > kMostCorners) table.fail(key, fmt::format("has more than {} points", kMostCorners), kSeePage);
  std::vector<Measures> out;
  for (const auto& [a, b] : *pairs)
    out.push_back({expression_of(table, key, a, names), expression_of(table, key, b, names)});
  return out;
}

Piece read_piece(base::TomlTable& table, std::span<const std::string> names, const ProfileLibrary& profiles) {
  Piece piece;
  const auto part = table.text("part");
  std::vector<std::string> parts;
  for (const std::string_view p : model::kElementPartNames) parts.emplace_back(p);
  const auto at = part ? std::find(parts.begin(), parts.end(), *part) : parts.end();
  if (at == parts.end()) {
    std::string list;
    for (const std::string& p : parts) list += (list.empty() ? "" : ", ") + p;
    table.fail("part", part ? fmt::format("cannot be \"{}\"", *part) : "is missing", "Known: " + list);
  }
  piece.part = static_cast<Part>(at - parts.begin());
  std::vector<std::string> counted(names.begin(), names.end());
  if (const auto count = table.number_or_text("count")) {
    piece.count = expression_of(table, "count", *count, names);
    counted.insert(counted.end(), {"i", "n"});
  }
  if (const auto when = table.number_or_text("when")) piece.when = expression_of(table, "when", *when, counted);
  read_form(table, counted, profiles, piece);
  table.finish();
  return piece;
}

}  // namespace blockrand::elements
