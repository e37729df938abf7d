// Figures in the text format of Prometheus, version 0.0.4 (https://prometheus.io/docs/instrumenting/exposition_formats/).
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blockrand::run {

/// Families of samples, in the order in which they are added.
class MetricsText {
 public:
  using Labels = std::vector<std::pair<std::string, std::string>>;

  /// \param common  labels of every sample, before its own
  explicit MetricsText(Labels common);

  /// Begins a family. Names end with their unit (_seconds, _bytes), those of counters with _total.
  /// \param name  letters, digits and underscores  \param help  one line; line feeds and backslashes are escaped
  void gauge(std::string_view name, std::string_view help);
  void counter(std::string_view name, std::string_view help);
  /// A sample of the family that was begun last. A value that is no finite number is written as NaN, +Inf or -Inf.
  /// \param labels  values may be any text: what is not UTF-8 is replaced
  void sample(double value, const Labels& labels = {});

  /// Families without a sample are left out.
  const std::string& text() const { return text_; }

 private:
  void begin(std::string_view name, std::string_view type, std::string_view help);

  Labels common_;
  std::string name_, head_, text_;
};

}  // namespace blockrand::run
