#include "importers/reference/coordinate_text.h"

#include <charconv>
#include <cmath>

namespace blockrand::importers::reference {
namespace {

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

/// Reads a number at `p` and moves behind it.
std::optional<double> read_number(const char*& p, const char* end) {
  if (p < end && *p == '+') ++p;
  double value = 0;
  const auto [next, error] = std::from_chars(p, end, value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  p = next;
  return value;
}

bool closes(const std::vector<double>& numbers, std::size_t dimension) {
  if (numbers.size() % dimension != 0 || numbers.size() < 2 * dimension) return false;
  for (std::size_t i = 0; i < dimension; ++i)
    if (numbers[i] != numbers[numbers.size() - dimension + i]) return false;
  return true;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> number_of(std::string_view text) {
  text = trimmed(text);
  const char *p = text.data(), *const end = p + text.size();
  const auto value = read_number(p, end);
  return p == end ? value : std::nullopt;
}

std::optional<int> whole_number_of(std::string_view text) {
  constexpr double kLargest = 1e9;
  const auto value = number_of(text);
  if (!value || *value != std::trunc(*value) || std::fabs(*value) > kLargest) return std::nullopt;
  return static_cast<int>(*value);
}

std::optional<int> year_of(std::string_view text) {
  text = trimmed(text);
  int year = 0;
  const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), year);
  const std::size_t used = static_cast<std::size_t>(next - text.data());
  if (error != std::errc() || used > 5) return std::nullopt;
  const bool ends = used == text.size() || text[used] == '-' || text[used] == '+' || text[used] == 'Z';
  return ends ? std::optional(year) : std::nullopt;
}

std::optional<std::vector<double>> numbers_of(std::string_view text) {
  std::vector<double> out;
  const char *p = text.data(), *const end = p + text.size();
  while (true) {
    while (p < end && is_space(*p)) ++p;
    if (p == end) return out;
    const auto value = read_number(p, end);
    if (!value || (p < end && !is_space(*p))) return std::nullopt;
    out.push_back(*value);
  }
}

std::string as_number_list(std::string_view text, const std::string& decimal, const std::string& within,
                           const std::string& between) {
  const char point = decimal.empty() ? '.' : decimal[0], comma = within.empty() ? ',' : within[0],
             space = between.empty() ? ' ' : between[0];
  std::string out(text);
  for (char& c : out) {
    if (c == point) {
      c = '.';
    } else if (c == comma || c == space) {
      c = ' ';
    }
  }
  return out;
}

std::optional<PointList> points_of(const std::vector<double>& numbers, int dimension) {
  if (dimension == 0) {
    const bool three = numbers.size() % 3 == 0, two = numbers.size() % 2 == 0;
    dimension = three && (!two || closes(numbers, 3) || !closes(numbers, 2)) ? 3 : 2;
  }
  const std::size_t step = static_cast<std::size_t>(dimension);
  if ((dimension != 2 && dimension != 3) || numbers.size() % step != 0) return std::nullopt;
  PointList out;
  out.two_dimensional = dimension == 2;
  out.points.reserve(numbers.size() / step);
  for (std::size_t i = 0; i < numbers.size(); i += step)
    out.points.push_back({numbers[i], numbers[i + 1], dimension == 3 ? numbers[i + 2] : 0});
  return out;
}

}  // namespace blockrand::importers::reference
