// The machine that the program runs on.
#pragma once

#include <string>

namespace blockrand::base {

/// Its name; empty where the system does not tell.
std::string host_name();

/// Names this process among those of all hosts and containers that share a disk: "node7-12345-9f3ac2d1". Containers may have one name, and
/// processes of one number: the last part is by chance. For names of what is in the making, which no output shows.
std::string process_name();

}  // namespace blockrand::base
