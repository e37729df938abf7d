// An extract that is piped in.
#pragma once

#include <optional>
#include <string>

#include "pipeline/base/progress.h"

namespace blockrand::cli {

/// What people call it.
inline constexpr const char* kStandardInput = "standard input";

/// All of standard input in a file without a name: it is gone with the process, however that ends. An extract is read several times,
/// and hashed.
class SpooledInput {
 public:
  /// \param folder  where the file lies, or would lie; of one that does not exist, the nearest that does
  /// \throws base::UsageError   standard input is a terminal, or closed
  /// \throws base::InputError   it is empty, or cannot be read
  /// \throws base::OutputError  the file cannot be written
  SpooledInput(const std::string& folder, base::Progress& progress);
  ~SpooledInput();
  SpooledInput(SpooledInput&& other) noexcept;
  SpooledInput& operator=(SpooledInput&&) = delete;

  /// By which it can be opened, any number of times.
  const std::string& path() const { return path_; }

 private:
  int file_ = -1;
  std::string path_;
};

/// Of the input "-": takes standard input, and `input` becomes the path of the copy. Of any other: nothing.
/// \param output  beside which the copy lies; empty: in the folder for temporary files
std::optional<SpooledInput> take_standard_input(std::string& input, const std::string& output,
                                                base::Progress& progress);

/// `text` with the name that people know in place of the path of a copy.
std::string with_told_input(std::string text, const SpooledInput& input);

/// Calls `command`; errors that name the path of the copy name standard input instead. \param input  nothing: no copy
template <class Command>
auto with_input_told(const std::optional<SpooledInput>& input, const Command& command);

}  // namespace blockrand::cli

#include "pipeline/base/error.h"

namespace blockrand::cli {

template <class Command>
auto with_input_told(const std::optional<SpooledInput>& input, const Command& command) {
  try {
    return command();
  } catch (const base::InputError& error) {
    if (!input) throw;
    throw base::InputError(with_told_input(error.what(), *input));
  } catch (const base::UsageError& error) {
    if (!input) throw;
    throw base::UsageError(with_told_input(error.what(), *input));
  }
}

}  // namespace blockrand::cli
