// The machine that the program runs on.
#pragma once

#include <string>

namespace blockrand::base {

/// Its name; empty where the system does not tell.
std::string host_name();

/// Names this process among those of all hosts that share a disk: "node7-12345".
std::string process_name();

}  // namespace blockrand::base
