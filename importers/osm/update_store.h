// Brings a store up to date with what differs: cells that hear of nothing stay as they lie. What a night takes grows with what changed,
// but for a copy of the files.
#pragma once

#include <span>
#include <string>

#include "importers/osm/apply_changes.h"

namespace blockrand::importers::osm {

/// Makes the store that write_store would make of an extract with the same objects of surroundings as the one before, from that of the extract before; places of objects within the file apart.
/// \param before   its files, in the order of kStoreFiles
/// \param changes  every object that is another one now (apply_changes)
/// \param extract  as it is now: asked for ways that nothing kept so far
/// \param folder   is made; what is there of an earlier store is replaced
/// \returns empty; or why the store must be written anew: it is told of ways by nodes that it did not have, the newest object is gone,
///          much of it would be of no use
/// \throws base::InputError   a file of the store is damaged, or the extract
/// \throws base::OutputError  the store cannot be written
std::string update_store(std::span<const std::string> before, const ChangedObjects& changes, const std::string& extract,
                         const std::string& folder);

}  // namespace blockrand::importers::osm
