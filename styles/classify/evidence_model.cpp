#include "styles/classify/evidence_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/base/portable_math.h"
#include "pipeline/base/toml_file.h"

namespace blockrand::classify {

namespace {

constexpr double kLogOddsStep = 4096, kProbabilityStep = 65536;
constexpr double kMaxWeight = 20;  ///< log-odds; e^20 is beyond any evidence

double spread(const PerAnswer& w, std::size_t n) {
  const auto [low, high] = std::minmax_element(w.begin(), w.begin() + static_cast<std::ptrdiff_t>(n));
  return *high - *low;
}

}  // namespace

double round_log_odds(double v) { return std::floor(v * kLogOddsStep + 0.5) / kLogOddsStep; }

PerAnswer probabilities(const PerAnswer& log_odds, std::size_t n) {
  PerAnswer p{};
  const double most = *std::max_element(log_odds.begin(), log_odds.begin() + static_cast<std::ptrdiff_t>(n));
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += p[i] = base::exp(log_odds[i] - most);
  for (std::size_t i = 0; i < n; ++i) p[i] = std::floor(p[i] / sum * kProbabilityStep + 0.5) / kProbabilityStep;
  return p;
}

EvidenceModel EvidenceModel::read(const std::string& path, std::span<const std::string_view> expected) {
  base::TomlTable file = base::TomlTable::read(path);
  EvidenceModel model;
  const auto answers = file.texts("answers");
  if (!answers || answers->empty()) file.fail("answers", "no answers", "List what the question can be answered with");
  if (answers->size() > kMaxAnswers) file.fail("answers", "more than 12 answers", "Merge some");
  if (!expected.empty() && !std::equal(answers->begin(), answers->end(), expected.begin(), expected.end())) {
    std::string list;
    for (const std::string_view a : expected) list += (list.empty() ? "" : ", ") + std::string(a);
    file.fail("answers", "these are not the answers of this question", "They are, in this order: " + list);
  }
  for (std::size_t i = 0; i < answers->size(); ++i)
    if (std::find(answers->begin(), answers->begin() + static_cast<std::ptrdiff_t>(i), (*answers)[i]) !=
        answers->begin() + static_cast<std::ptrdiff_t>(i))
      file.fail("answers", "`" + (*answers)[i] + "` stands there twice", "Name each answer once");
  model.answers_ = *answers;
  if (auto prior = file.table("prior")) {
    for (std::size_t a = 0; a < model.answers_.size(); ++a)
      model.prior_[a] = prior->number(model.answers_[a], -kMaxWeight, kMaxWeight).value_or(0);
    prior->finish();
  }
  for (std::size_t a = 0; a < model.answers_.size(); ++a)
    model.base_[a] = 1 / static_cast<double>(model.answers_.size());
  if (auto base = file.table("base")) {
    for (std::size_t a = 0; a < model.answers_.size(); ++a)
      if (const auto share = base->number(model.answers_[a], 1e-6, 1)) model.base_[a] = *share;
    base->finish();
  }
  if (auto features = file.table("feature")) {
    std::vector<std::string> names;
    for (const FeatureInfo& f : kFeatures) names.emplace_back(f.name);
    for (const std::string& name : features->keys()) {
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end()) {
        const std::string near = base::nearest(name, names);
        features->fail(name, "there is no feature `" + name + "`",
                       near.empty() ? "See docs/classification.md" : "Did you mean `" + near + "`?");
      }
      base::TomlTable table = *features->table(name);
      Table t;
      t.feature = static_cast<std::size_t>(found - names.begin());
      t.edges = table.numbers("edges").value_or(std::vector<double>{});
      for (std::size_t i = 0; i < t.edges.size(); ++i)
        if (!std::isfinite(t.edges[i]) || (i > 0 && !(t.edges[i - 1] < t.edges[i])))
          table.fail("edges", "edges do not ascend", "Each must be above the one before");
      t.bins.resize(t.edges.size() + 1);
      for (std::size_t a = 0; a < model.answers_.size(); ++a) {
        const auto weights = table.numbers(model.answers_[a]);
        if (!weights) continue;  // says nothing of this answer
        if (weights->size() != t.bins.size())
          table.fail(model.answers_[a],
                     std::to_string(weights->size()) + " weights for " + std::to_string(t.bins.size()) + " bins",
                     "Give one more weight than edges");
        for (std::size_t b = 0; b < t.bins.size(); ++b) {
          if (!(std::fabs((*weights)[b]) <= kMaxWeight))
            table.fail(model.answers_[a], "a weight beyond 20", "Log-odds of 5 are as good as certain");
          t.bins[b][a] = (*weights)[b];
        }
      }
      table.finish();
      model.tables_.push_back(std::move(t));
    }
    features->finish();
  }
  file.finish();
  std::sort(model.tables_.begin(), model.tables_.end(),
            [](const Table& a, const Table& b) { return a.feature < b.feature; });
  return model;
}

std::size_t EvidenceModel::Table::bin_of(double v) const {
  return static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), v) - edges.begin());
}

Contribution EvidenceModel::Table::at(std::size_t bin, double value) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {feature, value, bin == 0 ? -kInfinity : edges[bin - 1], bin == edges.size() ? kInfinity : edges[bin],
          bins[bin]};
}

PerAnswer EvidenceModel::log_odds(const FeatureVector& features, bool tags) const {
  PerAnswer sum = prior_;
  for (const Table& t : tables_) {
    const float v = features.at(t.feature);
    if (v != v || (!tags && is_tag(static_cast<Feature>(t.feature)))) continue;
    const PerAnswer& w = t.bins[t.bin_of(static_cast<double>(v))];
    for (std::size_t a = 0; a < answers_.size(); ++a) sum[a] += w[a];
  }
  for (std::size_t a = 0; a < answers_.size(); ++a) sum[a] = round_log_odds(sum[a]);
  return sum;
}

std::vector<Contribution> EvidenceModel::contributions(const FeatureVector& features, bool tags) const {
  std::vector<Contribution> out;
  for (const Table& t : tables_) {
    const float v = features.at(t.feature);
    if (v != v || (!tags && is_tag(static_cast<Feature>(t.feature)))) continue;
    out.push_back(t.at(t.bin_of(static_cast<double>(v)), static_cast<double>(v)));
  }
  std::stable_sort(out.begin(), out.end(), [&](const Contribution& a, const Contribution& b) {
    return spread(a.weights, answers_.size()) > spread(b.weights, answers_.size());
  });
  return out;
}

std::vector<Contribution> EvidenceModel::changes_to(const FeatureVector& features, std::size_t answer,
                                                    const PerAnswer& elsewhere, bool tags) const {
  // What all else says: the log-odds with the feature in question taken out.
  PerAnswer all = log_odds(features, tags);
  for (std::size_t a = 0; a < answers_.size(); ++a) all[a] += elsewhere[a];
  std::vector<Contribution> out;
  for (const Table& t : tables_) {
    const float v = features.at(t.feature);
    if (v != v || (!tags && is_tag(static_cast<Feature>(t.feature)))) continue;
    const std::size_t here = t.bin_of(static_cast<double>(v));
    std::size_t best = t.bins.size();
    for (std::size_t b = 0; b < t.bins.size(); ++b) {
      bool wins = b != here;
      for (std::size_t a = 0; a < answers_.size() && wins; ++a)
        wins = a == answer ||
               all[answer] - t.bins[here][answer] + t.bins[b][answer] > all[a] - t.bins[here][a] + t.bins[b][a];
      const auto away = [&](std::size_t bin) { return bin > here ? bin - here : here - bin; };
      if (wins && (best == t.bins.size() || away(b) < away(best))) best = b;
    }
    if (best < t.bins.size()) out.push_back(t.at(best, static_cast<double>(v)));
  }
  return out;
}

}  // namespace blockrand::classify
