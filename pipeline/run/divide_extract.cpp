#include "pipeline/run/divide_extract.h"

#include <filesystem>
#include <stdexcept>

#include "importers/osm/apply_changes.h"
#include "importers/osm/extract_store.h"
#include "importers/osm/update_store.h"
#include "pipeline/base/child_process.h"
#include "pipeline/base/error.h"
#include "pipeline/base/heap.h"
#include "pipeline/base/sha256.h"
#include "pipeline/run/build.h"

namespace blockrand::run {

namespace fs = std::filesystem;

std::uint64_t divide(const BuildOptions& options, const std::string& work, const EarlierStore& earlier,
                     std::string& written_because, base::Progress& progress) {
  const base::ChildResult result = base::run_in_child(options.input, [&](base::Progress& child) {
    base::keep_memory_low();
    std::error_code error;
    fs::create_directories(work, error);
    const std::string store = work + "/store", sorted = work + "/sorted.osm.pbf";
    std::string why;
    if (!earlier.files.empty()) try {
        why = base::sha256_file(earlier.files.back()) != earlier.nodes_sha256
                  ? "it is damaged"
                  : importers::osm::update_store(earlier.files, *earlier.changes, options.input, store);
        if (why.empty()) return why;
      } catch (const base::InputError&) {
        why = "it is damaged";
      }
    fs::remove_all(store, error);  // what was begun may be links to files of the earlier one
    if (!importers::osm::write_store(options.input, store, options.surroundings.any())) {
      const importers::osm::AppliedChanges applied = importers::osm::apply_changes(options.input, {}, sorted);
      if (applied.cleaned_texts)
        child.warn(told_input(options) + ": NUL characters in its texts were replaced; reports do not repeat that");
      if (!importers::osm::write_store(sorted, store, options.surroundings.any()))
        throw std::logic_error("a sorted extract is not sorted");
      fs::remove(sorted, error);
    }
    return why;
  });
  for (const std::string& warning : result.warnings) progress.warn(warning);
  written_because = result.bytes;
  return result.peak_rss_bytes;
}

}  // namespace blockrand::run
