#include "pipeline/outward/variants.h"

#include <algorithm>

#include "pipeline/outputs/gzip.h"
#include "pipeline/outward/part_file.h"

namespace blockrand::outward {

bool may_shrink(const std::string& path) {
  constexpr std::string_view kEnds[] = {".json", ".jsonl", ".html", ".gml", ".csv",
                                        ".tsv",  ".txt",   ".vrt",  ".glb", ".gpkg"};
  return std::ranges::any_of(kEnds, [&](std::string_view end) { return path.ends_with(end); });
}

std::string gzip_variant(const std::string& build, const BuildFile& file) {
  constexpr int kLevel = 9;  // written once, read often
  if (!may_shrink(file.path)) return {};
  const std::string plain = whole_file(build, file);
  std::string packed = outputs::gzip(plain, kLevel);
  const double most = (1 - kLeastSaving) * static_cast<double>(plain.size());
  return static_cast<double>(packed.size()) <= most ? packed : std::string();
}

}  // namespace blockrand::outward
