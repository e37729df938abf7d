# Rule files are read, resolved and checked.
set(grammar_language_sources
  bilke_import.cpp check.cpp check_rules.cpp check_sizes.cpp check_styles.cpp check_types.cpp file_search.cpp
  function_names.cpp lexer.cpp known_names.cpp operation_names.cpp other_names.cpp parse_declarations.cpp
  parse_expressions.cpp parse_successors.cpp parser_state.cpp program.cpp resolve_names.cpp source.cpp types.cpp
  value_text.cpp)
list(TRANSFORM grammar_language_sources PREPEND language/)
