// Additive evidence: each feature of a building speaks for or against each answer by a weight that stands in a text
// file.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "styles/classify/features.h"

namespace blockrand::classify {

/// More answers has no question.
inline constexpr std::size_t kMaxAnswers = 12;

/// One number per answer, unused ones 0.
using PerAnswer = std::array<double, kMaxAnswers>;

/// What one feature of a building says.
struct Contribution {
  std::size_t feature = 0;  ///< index into kFeatures
  double value = 0;
  double low = 0, high = 0;  ///< the bin it lies in: low <= value < high; infinite at the ends
  PerAnswer weights{};       ///< log-odds per answer
};

/// A question with a few answers, asked of a building's features:
///
///   log-odds(answer) = prior(answer) + sum over known features of weight(feature, bin of its value, answer)
///
/// and probability = exp(log-odds) / sum of exp over answers. That is multinomial logistic regression on binned
/// features (a generalised additive model, Hastie and Tibshirani 1990): every weight can be read, and edited.
class EvidenceModel {
 public:
  /// Reads configs/styles/weights/<question>.toml. Its keys: `answers`, [prior], [base] (shares of the
  /// answers in the data of the fit), and a table [feature.<name>] per feature
  /// with ascending `edges` and per answer the weights of its bins (one more than edges).
  /// \param answers  that the file must have, in this order; empty: any
  /// \throws base::InputError  for anything unknown, missing or of the wrong length, with file, line and column
  static EvidenceModel read(const std::string& path, std::span<const std::string_view> answers = {});

  const std::vector<std::string>& answers() const { return answers_; }
  /// Whether it has weights for the feature: others can take any value without a word in any answer.
  bool asks(std::size_t feature) const {
    return std::ranges::any_of(tables_, [feature](const Table& t) { return t.feature == feature; });
  }

  /// Log-odds per answer.
  /// \param tags  false: features of the group `tag` are not asked
  PerAnswer log_odds(const FeatureVector& features, bool tags = true) const;
  /// The terms of log_odds but for the prior, the weightiest first (by the spread of their weights).
  std::vector<Contribution> contributions(const FeatureVector& features, bool tags = true) const;
  const PerAnswer& prior() const { return prior_; }
  /// Shares of the answers in the data that the weights were fitted on, what `prior` stands for; all the same where the
  /// file does not tell.
  const PerAnswer& base() const { return base_; }

  /// What the nearest change of one feature would be that makes `answer` the likeliest: the feature and the bin it
  /// would have to lie in; empty where no single feature does.
  std::vector<Contribution> changes_to(const FeatureVector& features, std::size_t answer, const PerAnswer& elsewhere,
                                       bool tags = true) const;

 private:
  struct Table {
    std::size_t feature = 0;
    std::vector<double> edges;
    std::vector<PerAnswer> bins;  ///< edges + 1
    std::size_t bin_of(double v) const;
    Contribution at(std::size_t bin, double value) const;
  };
  std::vector<std::string> answers_;
  PerAnswer prior_{}, base_{};
  std::vector<Table> tables_;  ///< in the order of kFeatures
};

/// Log-odds to probabilities; the first `n` entries. Rounded to 1/65536, so that the order of sums reaches no output.
PerAnswer probabilities(const PerAnswer& log_odds, std::size_t n);

/// Log-odds are rounded to 1/4096 before they are compared or handed on.
double round_log_odds(double v);

}  // namespace blockrand::classify
