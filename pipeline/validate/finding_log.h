// Findings of a run: the first of each kind are kept, all are counted, in the order in which they are added.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/validate/finding.h"

namespace blockrand::validate {

class FindingLog {
 public:
  /// A damaged file can break a rule a million times: of each check only so many findings are kept.
  static constexpr std::uint64_t kKeptPerCheck = 500;

  void add(Finding finding) {
    if (++counts_[static_cast<std::size_t>(finding.check)] <= kKeptPerCheck) kept_.push_back(std::move(finding));
  }
  void add(Check check, std::string file, std::string object, std::string detail) {
    add({check, std::move(file), std::move(object), std::move(detail)});
  }
  void add(std::vector<Finding>&& findings) {
    for (Finding& f : findings) add(std::move(f));
    findings.clear();
  }
  void append(FindingLog&& other) {
    std::array<std::uint64_t, kCheckCount> kept{};
    for (Finding& f : other.kept_) {
      ++kept[static_cast<std::size_t>(f.check)];
      add(std::move(f));
    }
    for (std::size_t i = 0; i < kept.size(); ++i) counts_[i] += other.counts_[i] - kept[i];
    other = {};
  }

  const std::vector<Finding>& kept() const { return kept_; }
  std::uint64_t count(Check check) const { return counts_[static_cast<std::size_t>(check)]; }
  std::uint64_t count() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t c : counts_) sum += c;
    return sum;
  }

 private:
  std::vector<Finding> kept_;
  std::array<std::uint64_t, kCheckCount> counts_{};
};

}  // namespace blockrand::validate
