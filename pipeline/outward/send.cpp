#include "pipeline/outward/send.h"

#include <algorithm>
#include <ctime>
#include <set>

#include "pipeline/outward/variants.h"

namespace blockrand::outward {
namespace {

constexpr const char* kVariants = "variants";  // note of a target: which variants lie there
constexpr const char* kGzip = "gzip";

/// Steps in batches of at most `most` files; a batch never has files of two steps.
std::vector<Batch> batches_of(const std::vector<SendStep>& steps, std::size_t most) {
  std::vector<Batch> batches;
  for (const SendStep& step : steps)
    for (std::size_t first = 0; first < step.files.size(); first += most) {
      const auto begin = step.files.begin() + static_cast<std::ptrdiff_t>(first);
      const auto end = step.files.begin() + static_cast<std::ptrdiff_t>(std::min(first + most, step.files.size()));
      batches.push_back({.step = step.step, .files = {begin, end}});
    }
  return batches;
}

class Sender {
 public:
  Sender(const std::string& build, const std::map<std::string, BuildFile>& files, const Target& target,
         TargetState& state, const SendOptions& options, base::Progress& progress)
      : files_(files), target_(target), state_(state), options_(options), progress_(progress) {
    if (options.gzip)
      variant_ = [this, build](const BuildFile& file) {
        return has_variant(file) ? gzip_variant(build, file) : std::string();
      };
  }

  SendSummary send() {
    settle_variants(state_, options_);
    settle_doubts();
    const SendPlan plan = look_ahead(files_, state_, options_, unix_time());
    summary_.unchanged = plan.unchanged;
    put(plan);
    // The new tileset stands: from now on nobody is led to what left.
    const std::int64_t now = unix_time();
    for (const std::string& path : plan.stay) state_.stays(path);
    for (const std::string& path : plan.leave) state_.leaves(path, now);
    remove(look_ahead(files_, state_, options_, now));
    state_.set_build(files_.at("build.json").sha256);
    state_.save();
    return summary_;
  }

 private:
  std::size_t most() const { return static_cast<std::size_t>(std::max(options_.batch, 1)); }

  /// Whether one may be made; builds have some themselves (build --precompress).
  bool has_variant(const BuildFile& file) const {
    return options_.gzip && may_shrink(file.path) && !files_.contains(file.path + ".gz");
  }

  /// What a run that was broken off had sent whole is noted as that; where a variant belongs to it, nobody knows which.
  void settle_doubts() {
    if (!target_.has) return;
    const std::set<std::string> doubts = state_.in_doubt();
    for (const std::string& path : doubts)
      if (const auto file = files_.find(path);
          file != files_.end() && !has_variant(file->second) && target_.has(file->second))
        state_.put(path, file->second.sha256), ++summary_.found;
  }

  void put(const SendPlan& plan) {
    std::vector<Batch> batches = batches_of(plan.steps, most());
    if (!batches.empty()) progress_.begin("send", plan.files, "files");
    for (std::size_t i = 0; i < batches.size(); ++i) {
      batches[i].number = static_cast<int>(i) + 1, batches[i].of = static_cast<int>(batches.size());
      put(batches[i]);
      progress_.advance_to(summary_.files);
    }
  }

  void put(const Batch& batch) {
    std::vector<std::string> touched;
    std::set<std::string> without;  // variants that none is made of now
    for (const BuildFile& file : batch.files) {
      touched.push_back(file.path);
      const std::string variant = file.path + ".gz";
      if (!has_variant(file)) continue;
      touched.push_back(variant);
      // One that was there stays in doubt: it is removed at the end, of this run or of the next.
      const bool was = state_.here().contains(variant) || state_.in_doubt().contains(variant);
      if (!was) without.insert(variant);
    }
    state_.begin(touched);
    for (const std::string& path : target_.put(batch, variant_)) {
      state_.put(path, kGzip), without.erase(path);
      ++summary_.variants;
    }
    for (const std::string& path : without) state_.removed(path);
    for (const BuildFile& file : batch.files) {
      state_.put(file.path, file.sha256);
      ++summary_.files, summary_.bytes += file.bytes;
    }
  }

  void remove(const SendPlan& plan) {
    const std::vector<std::string>& paths = plan.remove;
    const std::size_t calls = (paths.size() + most() - 1) / most();
    for (std::size_t i = 0; i < calls; ++i) {
      const auto some = std::span(paths).subspan(i * most(), std::min(most(), paths.size() - i * most()));
      state_.begin(some);
      target_.remove(some, static_cast<int>(i) + 1, static_cast<int>(calls));
      for (const std::string& path : some) state_.removed(path);
    }
    summary_.removed = paths.size(), summary_.later = plan.later.size();
  }

  const std::map<std::string, BuildFile>& files_;
  const Target& target_;
  TargetState& state_;
  const SendOptions& options_;
  base::Progress& progress_;
  MakeVariant variant_;
  SendSummary summary_;
};

}  // namespace

std::int64_t unix_time() { return static_cast<std::int64_t>(std::time(nullptr)); }

void settle_variants(TargetState& state, const SendOptions& options) {
  const std::string variants = options.gzip ? kGzip : "none";
  if (options.gzip && state.note(kVariants) != variants) state.forget();
  state.set_note(kVariants, variants);
}

SendPlan look_ahead(const std::map<std::string, BuildFile>& files, const TargetState& state, const SendOptions& options,
                    std::int64_t now) {
  constexpr double kHour = 3600;  // s
  return plan_to_send(files, state,
                      {.now = now,
                       .keep_deleted = static_cast<std::int64_t>(options.keep_deleted_hours * kHour),
                       .variants = options.gzip});
}

SendSummary send_build(const std::string& build, const std::map<std::string, BuildFile>& files, const Target& target,
                       TargetState& state, const SendOptions& options, base::Progress& progress) {
  return Sender(build, files, target, state, options, progress).send();
}

}  // namespace blockrand::outward
