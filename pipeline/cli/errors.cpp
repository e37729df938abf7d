#include "pipeline/cli/errors.h"

#include <exception>
#include <new>

#include "pipeline/base/error.h"
#include "pipeline/cli/exit_codes.h"

namespace blockrand::cli {

int guarded(base::LogFormat format, const std::function<int()>& command) {
  base::Progress messages(base::ProgressStyle::none, format);
  try {
    return command();
  } catch (const base::UsageError& error) {
    messages.error(error.what());
    return kWrongUsage;
  } catch (const base::InputError& error) {
    messages.error(error.what());
    return kInvalidInput;
  } catch (const base::OutputError& error) {
    messages.error(error.what());
    return kInternalError;
  } catch (const std::bad_alloc&) {
    messages.error("not enough memory. Use fewer --jobs, or build a part of the extract with --bbox.");
    return kInternalError;
  } catch (const std::exception& error) {
    messages.error(std::string("internal error: ") + error.what() +
                   ". This is a bug: please report it with the command.");
    return kInternalError;
  }
}

base::LogFormat early_log_format(const std::vector<std::string>& arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const bool next_is_json = i + 1 < arguments.size() && arguments[i + 1] == "json";
    if (arguments[i] == "--log-format=json" || (arguments[i] == "--log-format" && next_is_json))
      return base::LogFormat::json;
  }
  return base::LogFormat::text;
}

}  // namespace blockrand::cli
