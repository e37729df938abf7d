// Results of pieces of work that an earlier run may have left: a piece is named by everything that it depends on, so that what is
// remembered of it is what working would give.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "pipeline/base/pack.h"
#include "pipeline/base/sha256.h"

namespace blockrand::base {

/// Where results are looked up and kept. Its functions may be called from several threads at a time.
struct Memo {
  /// What all pieces of work depend on alike: program, options, coordinate system.
  std::string shared;
  std::function<std::optional<std::string>(std::string_view kind, const std::string& key)> find;
  std::function<void(std::string_view kind, const std::string& key, std::string_view bytes)> keep;
};

/// The result of `work`, remembered where it can be.
/// \param memo   null: nothing is remembered
/// \param kind   one word, of the work
/// \param reads  packs everything that the work reads, and nothing that numbers things in this run alone
/// \param work   returns a Result, which must pack and unpack (pack.h)
template <class Result, class Reads, class Work>
Result remembered(const Memo* memo, std::string_view kind, Reads&& reads, Work&& work) {
  if (!memo) return work();
  Packer inputs;
  inputs << memo->shared << kind;
  reads(inputs);
  const std::string key = sha256_of(inputs.bytes);
  if (const std::optional<std::string> bytes = memo->find(kind, key)) try {
      return unpacked<Result>(*bytes);
    } catch (const UnpackError&) {
      // Of no use: it is worked out anew.
    }
  Result result = work();
  memo->keep(kind, key, packed(result));
  return result;
}

}  // namespace blockrand::base
