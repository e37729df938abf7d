#include "pipeline/outward/variants.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/outputs/gzip.h"
#include "pipeline/outward/target.h"

namespace blockrand::outward {

bool may_shrink(const std::string& path) {
  constexpr std::string_view kEnds[] = {".json", ".jsonl", ".html", ".gml", ".csv",
                                        ".tsv",  ".txt",   ".vrt",  ".glb", ".gpkg"};
  return std::ranges::any_of(kEnds, [&](std::string_view end) { return path.ends_with(end); });
}

std::string gzip_variant(const std::string& build, const BuildFile& file) {
  constexpr int kLevel = 9;  // written once, read often
  if (!may_shrink(file.path)) return {};
  check_there(build, file);
  std::ifstream in(build + "/" + file.path, std::ios::binary);
  std::stringstream bytes;
  bytes << in.rdbuf();
  const std::string plain = std::move(bytes).str();
  if (base::sha256_of(plain) != file.sha256)
    throw base::InputError(build + "/" + file.path, "", "is not the file that build.json names: the build is damaged",
                           "'blockrand validate' tells what else is; build again");
  std::string packed = outputs::gzip(plain, kLevel);
  const double most = (1 - kLeastSaving) * static_cast<double>(plain.size());
  return static_cast<double>(packed.size()) <= most ? packed : std::string();
}

}  // namespace blockrand::outward
