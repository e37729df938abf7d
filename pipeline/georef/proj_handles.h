// PROJ's handles as owners. Internal to this folder.
#pragma once

#include <memory>
#include <string>

#include "pipeline/georef/proj_library.h"

namespace blockrand::georef::detail {

struct ContextDeleter {
  void operator()(PJ_CONTEXT* c) const { proj().proj_context_destroy(c); }
};
struct PjDeleter {
  void operator()(PJ* p) const { proj().proj_destroy(p); }
};
struct ListDeleter {
  void operator()(PJ_OBJ_LIST* l) const { proj().proj_list_destroy(l); }
};
struct FactoryDeleter {
  void operator()(PJ_OPERATION_FACTORY_CONTEXT* c) const { proj().proj_operation_factory_context_destroy(c); }
};

using Context = std::unique_ptr<PJ_CONTEXT, ContextDeleter>;
using Pj = std::unique_ptr<PJ, PjDeleter>;
using PjList = std::unique_ptr<PJ_OBJ_LIST, ListDeleter>;
using Factory = std::unique_ptr<PJ_OPERATION_FACTORY_CONTEXT, FactoryDeleter>;

/// A context that never asks the network and never prints: results depend on the installed packages alone.
inline Context make_context() {
  Context context(proj().proj_context_create());
  proj().proj_context_set_enable_network(context.get(), 0);
  proj().proj_log_level(context.get(), PJ_LOG_NONE);
  return context;
}

inline std::string text(const char* s) { return s == nullptr ? std::string() : std::string(s); }

}  // namespace blockrand::georef::detail
