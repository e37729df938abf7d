// Errors that cross a file boundary. Programming errors assert; a bad building is an issue code, not an exception.
#pragma once

#include <stdexcept>
#include <string>

namespace blockrand::base {

/// Input that cannot be read or is invalid: exit code 2. The text names file, place and remedy.
class InputError : public std::runtime_error {
 public:
  /// \param file      path as the user gave it
  /// \param place     line, byte, layer or object id; may be empty
  /// \param what      what is wrong, without a full stop
  /// \param remedy    what the user can do; may be empty
  InputError(const std::string& file, const std::string& place, const std::string& what, const std::string& remedy)
      : std::runtime_error(file + (place.empty() ? "" : ":" + place) + ": " + what +
                           (remedy.empty() ? "" : ". " + remedy)) {}
  /// One that another process threw. \param text  whole
  explicit InputError(const std::string& text) : std::runtime_error(text) {}
};

/// Wrong options or an output place that cannot be used: exit code 1.
class UsageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Output could not be written (disk full, permission): exit code 4; nothing half-written stays behind.
class OutputError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace blockrand::base
