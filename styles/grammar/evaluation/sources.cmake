# Rules are run: values, functions, derivation.
set(grammar_evaluation_sources
  arrays.cpp asset_files.cpp derive.cpp derive_attributes.cpp derive_blocks.cpp derive_steps.cpp evaluate.cpp
  evaluate_shape_functions.cpp functions.cpp functions_arrays.cpp functions_colour.cpp
  functions_conversion.cpp functions_files.cpp functions_lists.cpp functions_maths.cpp functions_text.cpp
  operators.cpp pattern.cpp rule_tests.cpp)
list(TRANSFORM grammar_evaluation_sources PREPEND evaluation/)
