#include "pipeline/base/shared_library.h"

#include <dlfcn.h>

#include "pipeline/base/error.h"

namespace blockrand::base {

SharedLibrary::SharedLibrary(const char* soname, const char* purpose)
    : soname_(soname), purpose_(purpose), handle_(::dlopen(soname, RTLD_LAZY | RTLD_LOCAL)) {
  if (handle_ == nullptr) fail();
}

void* SharedLibrary::symbol(const char* name) const {
  void* const found = ::dlsym(handle_, name);
  if (found == nullptr) fail();
  return found;
}

void SharedLibrary::fail() const {
  const char* const why = ::dlerror();
  throw UsageError(std::string(purpose_) + ", cannot be loaded: " + (why != nullptr ? why : "unknown failure") +
                   ". Install the package that holds " + soname_);
}

}  // namespace blockrand::base
