#include "pipeline/base/host.h"

#include <sys/random.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <ctime>

namespace blockrand::base {

std::string host_name() {
  char host[256] = "";
  ::gethostname(host, sizeof host - 1);
  return host;
}

std::string process_name() {
  static const std::string by_chance = [] {
    std::uint32_t bits = 0;
    if (::getrandom(&bits, sizeof bits, 0) != sizeof bits) bits = static_cast<std::uint32_t>(::time(nullptr));
    char text[16];
    std::snprintf(text, sizeof text, "%08x", bits);
    return std::string(text);
  }();
  // A child of this process has its chance, and another number.
  return host_name() + "-" + std::to_string(::getpid()) + "-" + by_chance;
}

}  // namespace blockrand::base
