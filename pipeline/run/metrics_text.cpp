#include "pipeline/run/metrics_text.h"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/base/markup.h"

namespace blockrand::run {
namespace {

/// \param quotes  whether they are escaped as well: in values of labels, not in help
std::string escaped_line(std::string_view text, bool quotes) {
  std::string clean, out;
  base::append_clean(clean, text);
  for (const char c : clean) {
    if (c == '\n')
      out += "\\n";
    else if (c == '\\' || (quotes && c == '"'))
      out += '\\', out += c;
    else
      out += c;
  }
  return out;
}

std::string number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
  return fmt::format("{}", value);  // the shortest that reads back as the same
}

}  // namespace

MetricsText::MetricsText(Labels common) : common_(std::move(common)) {}

void MetricsText::begin(std::string_view name, std::string_view type, std::string_view help) {
  name_ = name;
  head_ = fmt::format("# HELP {} {}\n# TYPE {} {}\n", name, escaped_line(help, false), name, type);
}

void MetricsText::gauge(std::string_view name, std::string_view help) { begin(name, "gauge", help); }
void MetricsText::counter(std::string_view name, std::string_view help) { begin(name, "counter", help); }

void MetricsText::sample(double value, const Labels& labels) {
  text_ += std::exchange(head_, {});
  text_ += name_;
  std::string inside;
  for (const Labels* some : {&std::as_const(common_), &labels})
    for (const auto& [label, text] : *some)
      inside += fmt::format("{}{}=\"{}\"", inside.empty() ? "" : ",", label, escaped_line(text, true));
  if (!inside.empty()) text_ += "{" + inside + "}";
  text_ += " " + number(value) + "\n";
}

}  // namespace blockrand::run
