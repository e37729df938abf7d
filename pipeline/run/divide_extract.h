// The extract as a store that areas read: made from that of the night before where that is kept, else written anew.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/run/options.h"

namespace blockrand::run {

/// The store of the data of an earlier build, and what is otherwise now.
struct EarlierStore {
  std::vector<std::string> files;  ///< in the order of kStoreFiles; empty: there is none
  std::string nodes_sha256;        ///< of the last one, which no piece of it says
  std::shared_ptr<const importers::osm::ChangedObjects> changes;
};

/// The extract as a store, sorted first where it is not. In a process of its own, so that its buffers are gone afterwards.
/// \param written_because  gets why it was not made from the earlier one, which there is; empty: it was
/// \returns  its peak of memory, bytes
/// \throws base::InputError, base::OutputError  as write_store
std::uint64_t divide(const BuildOptions& options, const std::string& work, const EarlierStore& earlier,
                     std::string& written_because, base::Progress& progress);

}  // namespace blockrand::run
