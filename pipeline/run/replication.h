// A folder of change files with sequence numbers: the layout of planet.openstreetmap.org's replication and Geofabrik's
// updates (OpenStreetMap wiki, "Planet.osm/diffs"): state.txt, and AAA/BBB/CCC.osc.gz beside AAA/BBB/CCC.state.txt.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace blockrand::run {

struct ReplicationFile {
  std::uint64_t sequence = 0;
  std::string path;
  std::string time;  ///< of its data, ISO 8601; empty where its state file is missing
};

/// \param from  number of the first file that is wanted
/// \returns  the files from there to the newest that state.txt names, without a gap; empty where there is nothing new
/// \throws base::InputError  no folder, no state.txt, one without a number or one that is behind, a file that is missing
std::vector<ReplicationFile> replication_files(const std::string& folder, std::uint64_t from);

}  // namespace blockrand::run
