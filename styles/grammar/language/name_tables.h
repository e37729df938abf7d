// The rows that known_names.cpp is made of; nobody else includes this.
#pragma once

#include <span>
#include <string_view>

#include "styles/grammar/language/known_names.h"

namespace blockrand::grammar::tables {

struct WordSet {
  std::string_view name;
  std::span<const std::string_view> words;
};

std::span<const BuiltIn> operation_rows();
std::span<const BuiltIn> function_rows();
std::span<const BuiltIn> other_rows();  ///< attributes, selectors, annotations, keywords, forms of syntax
std::span<const WordSet> word_sets();

}  // namespace blockrand::grammar::tables
