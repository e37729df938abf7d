#include "pipeline/base/host.h"

#include <unistd.h>

namespace blockrand::base {

std::string host_name() {
  char host[256] = "";
  ::gethostname(host, sizeof host - 1);
  return host;
}

std::string process_name() { return host_name() + "-" + std::to_string(::getpid()); }

}  // namespace blockrand::base
