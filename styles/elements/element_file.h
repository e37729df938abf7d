// Element files, configs/elements/*.toml: kinds that cost no C++ (docs/element_files.md). Internal to this folder.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "styles/elements/element_piece.h"
#include "styles/elements/placed_model.h"

namespace blockrand::elements {

/// What a file says of a kind.
struct ElementFile {
  ElementKind kind;
  std::string file;                  ///< for messages
  Generator base = nullptr;          ///< of the built-in kind that it varies
  std::string base_kind;             ///< its name; empty: none
  std::vector<std::string> names;    ///< what expressions may ask for: `w`, `h`, numbers among the parameters, `reveal`
  std::optional<Expression> reveal;  ///< m, of openings whose reveal is no parameter
  std::vector<Measures> outline;     ///< of openings; empty: the rectangle
  std::vector<Piece> pieces;
  std::vector<int> piece_lines;  ///< where they stand
  std::optional<PlacedModel> model;
  std::string model_path;
  std::string licence, source, author;
};

/// Reads the text of an element file.
/// \param file  its path, for messages and for models beside it
/// \param name  of the kind: the file's without its ending
/// \throws base::InputError  with file and place: unknown keys and names, what is no expression, ranges that do not rise
ElementFile parse_element_file(std::string_view text, const std::string& file, const std::string& name,
                               const ProfileLibrary& profiles, const ModelReader& reader = {});

/// Fills opening and mesh. Error: the piece and what is wrong with it.
Made make_from_file(const ElementFile& file, const Request& request, Element& element);

/// Makes the kind at its least, usual and most size, at each level of detail.
/// \throws base::InputError  it cannot be made, or is no sound element
void check_element_file(const ElementFile& file, const ProfileLibrary& profiles);

/// What is wrong with an element, with its opening and whether it covers that; empty when all is well.
std::string element_defect(const Element& element, double width, double height, bool covers);

}  // namespace blockrand::elements
