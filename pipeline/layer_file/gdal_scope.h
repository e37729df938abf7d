// GDAL's messages and settings, kept to one thread and one scope. Internal to this folder.
#pragma once

#include <cpl_conv.h>
#include <cpl_error.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace blockrand::layer_file {

/// While it lives, GDAL on this thread prints nothing and sees the given configuration options; other threads and later
/// calls are untouched. The first failure stays readable: what follows it is usually its consequence.
class GdalScope {
 public:
  using Options = std::vector<std::pair<std::string, std::string>>;

  explicit GdalScope(const Options& options) {
    CPLPushErrorHandlerEx(&GdalScope::take, this);
    CPLErrorReset();
    for (const auto& [key, value] : options) {
      const char* const before = CPLGetThreadLocalConfigOption(key.c_str(), nullptr);
      before_.emplace_back(key, before != nullptr ? std::make_unique<std::string>(before) : nullptr);
      CPLSetThreadLocalConfigOption(key.c_str(), value.c_str());
    }
  }
  ~GdalScope() {
    for (const auto& [key, value] : before_)
      CPLSetThreadLocalConfigOption(key.c_str(), value ? value->c_str() : nullptr);
    CPLPopErrorHandler();
  }
  GdalScope(const GdalScope&) = delete;
  GdalScope& operator=(const GdalScope&) = delete;

  bool failed() const { return !failure_.empty(); }
  const std::string& failure() const { return failure_; }

 private:
  static void CPL_STDCALL take(CPLErr severity, CPLErrorNum, const char* message) {
    auto* const self = static_cast<GdalScope*>(CPLGetErrorHandlerUserData());
    if (severity >= CE_Failure && self->failure_.empty())
      self->failure_ = message != nullptr && *message != '\0' ? message : "unknown failure";
  }

  std::vector<std::pair<std::string, std::unique_ptr<std::string>>> before_;
  std::string failure_;
};

}  // namespace blockrand::layer_file
