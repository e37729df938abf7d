// The table of functions put together, and how one is found and called.
#include "styles/grammar/evaluation/functions.h"

#include <algorithm>

#include "pipeline/base/random.h"
#include "styles/grammar/evaluation/function_groups.h"
#include "styles/grammar/language/value_text.h"

namespace blockrand::grammar {
namespace {

std::vector<FunctionEntry> all_functions() {
  std::vector<FunctionEntry> out;
  for (const auto group : {maths_functions(), conversion_functions(), text_functions(), list_functions(),
                           array_functions(), colour_functions(), file_functions()})
    out.insert(out.end(), group.begin(), group.end());
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return out;
}

bool takes(char parameter, Type type) {
  switch (parameter) {
    case 'n':
      return type == Type::number;
    case 'b':
      return type == Type::truth;
    case 's':
      return type == Type::text;
    case 'N':
      return type == Type::number_array;
    case 'B':
      return type == Type::truth_array;
    case 'S':
      return type == Type::text_array;
  }
  return false;
}

/// Replaces what is no finite number. \returns whether anything was replaced
bool make_finite(Value& value) {
  bool changed = false;
  const auto mend = [&](double& number) {
    if (std::isfinite(number)) return;
    number = 0;
    changed = true;
  };
  if (auto* number = std::get_if<double>(&value)) mend(*number);
  if (auto* array = std::get_if<NumberArray>(&value)) std::for_each(array->items.begin(), array->items.end(), mend);
  return changed;
}

bool is_finite(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return std::isfinite(*number);
  if (const auto* array = std::get_if<NumberArray>(&value))
    return std::all_of(array->items.begin(), array->items.end(), [](double item) { return std::isfinite(item); });
  return true;
}

}  // namespace

double FunctionContext::draw() {
  const std::uint32_t number = draws != nullptr ? (*draws)++ : 0;
  return static_cast<double>(base::mix64(base::mix64(seed) ^ number) >> 11) * 0x1.0p-53;
}

void FunctionContext::warn(std::string message) const {
  if (warnings != nullptr) warnings->push_back(std::move(message));
}

std::span<const FunctionEntry> functions() {
  static const std::vector<FunctionEntry> kAll = all_functions();
  return kAll;
}

std::span<const FunctionEntry> find_functions(std::string_view name) {
  const auto all = functions();
  const auto found = std::equal_range(all.begin(), all.end(), FunctionEntry{name, {}},
                                      [](const auto& a, const auto& b) { return a.name < b.name; });
  return all.subspan(static_cast<std::size_t>(found.first - all.begin()),
                     static_cast<std::size_t>(found.second - found.first));
}

const FunctionEntry* choose_overload(std::span<const FunctionEntry> overloads, std::span<const Value> arguments) {
  for (const FunctionEntry& entry : overloads) {
    if (entry.parameters == "a+" && !arguments.empty()) return &entry;
    if (entry.parameters.size() != arguments.size()) continue;
    bool fits = true;
    for (std::size_t i = 0; i < arguments.size() && fits; ++i) fits = takes(entry.parameters[i], type_of(arguments[i]));
    if (fits) return &entry;
  }
  return nullptr;
}

FunctionResult call(const FunctionEntry& entry, std::span<const Value> arguments, FunctionContext& context) {
  if (entry.takes_nan || std::all_of(arguments.begin(), arguments.end(), is_finite)) {
    auto result = entry.run(arguments, context);
    if (result)
      if (const auto* text = std::get_if<std::string>(&*result); text != nullptr && text->size() > kMostTextBytes)
        return failure("the text becomes too long");
    return result;
  }
  std::vector<Value> mended(arguments.begin(), arguments.end());
  for (std::size_t i = 0; i < mended.size(); ++i)
    if (make_finite(mended[i]))
      context.warn("argument " + std::to_string(i + 1) + " of " + std::string(entry.name) +
                   " is not a finite number; 0 is taken instead");
  return entry.run(mended, context);
}

FunctionResult call(std::string_view name, std::span<const Value> arguments, FunctionContext& context) {
  const auto overloads = find_functions(name);
  if (overloads.empty()) return failure("there is no function " + std::string(name));
  if (const FunctionEntry* entry = choose_overload(overloads, arguments)) return call(*entry, arguments, context);
  std::string given;
  for (const Value& argument : arguments)
    given += (given.empty() ? "" : ", ") + std::string(type_name(type_of(argument)));
  return failure("no " + std::string(name) + " takes (" + given + ")");
}

}  // namespace blockrand::grammar
