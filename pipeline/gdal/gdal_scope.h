// How this program calls GDAL: drivers, messages and settings, kept to one thread and one scope. For the sources of the
// three folders that read and write with it; their headers show nothing of GDAL.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/gdal/gdal_library.h"

namespace blockrand::gdal {

inline void register_drivers() {
  static std::once_flag registered;
  std::call_once(registered, [] { api().GDALAllRegister(); });
}

struct CloseDataset {
  void operator()(GDALDatasetH dataset) const { api().GDALClose(dataset); }
};

/// While it lives, GDAL on this thread prints nothing (but what CPL_DEBUG asks for) and sees the given configuration
/// options; other threads and later calls are untouched. The first failure stays readable: what follows it is usually
/// its consequence, and drivers reset their own.
class GdalScope {
 public:
  using Options = std::vector<std::pair<std::string, std::string>>;

  explicit GdalScope(const Options& options = {}) {
    api().CPLPushErrorHandlerEx(&GdalScope::take, this);
    api().CPLErrorReset();
    for (const auto& [key, value] : options) {
      const char* const before = api().CPLGetThreadLocalConfigOption(key.c_str(), nullptr);
      before_.emplace_back(key, before != nullptr ? std::make_unique<std::string>(before) : nullptr);
      api().CPLSetThreadLocalConfigOption(key.c_str(), value.c_str());
    }
  }
  ~GdalScope() {
    for (const auto& [key, value] : before_)
      api().CPLSetThreadLocalConfigOption(key.c_str(), value ? value->c_str() : nullptr);
    api().CPLPopErrorHandler();
  }
  GdalScope(const GdalScope&) = delete;
  GdalScope& operator=(const GdalScope&) = delete;

  bool failed() const { return failed_; }
  /// What GDAL said when it first failed, or `otherwise` where it gave no reason.
  std::string failure(const char* otherwise) const { return failure_.empty() ? otherwise : failure_; }
  /// What GDAL said last, as an addition to a message of ours: " (GDAL: ...)"; empty where it said nothing.
  static std::string last_words() {
    const std::string text = api().CPLGetLastErrorMsg();
    return text.empty() ? "" : " (GDAL: " + text + ")";
  }

 private:
  static void CPL_STDCALL take(CPLErr severity, CPLErrorNum number, const char* message) {
    if (severity == CE_Debug) return api().CPLDefaultErrorHandler(severity, number, message);
    auto* const self = static_cast<GdalScope*>(api().CPLGetErrorHandlerUserData());
    if (severity < CE_Failure || self->failed_) return;
    self->failed_ = true;
    if (message != nullptr) self->failure_ = message;
  }

  std::vector<std::pair<std::string, std::unique_ptr<std::string>>> before_;
  bool failed_ = false;
  std::string failure_;
};

}  // namespace blockrand::gdal
