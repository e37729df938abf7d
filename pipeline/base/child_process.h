// Work in processes of their own: what they take of memory goes back to the system when they end, and one that dies takes nothing
// with it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace blockrand::base {

class Progress;

/// What a child sends back.
struct ChildResult {
  std::string bytes;                  ///< what its work returned
  std::vector<std::string> warnings;  ///< that it told, in their order
  std::uint64_t peak_rss_bytes = 0;
  double cpu_seconds = 0;
};

/// A piece of work. \param progress  shows nothing; its warnings are sent back
using ChildWork = std::function<std::string(Progress& progress)>;

/// Runs work(0) … work(count - 1), each in a child of this process, `at_once` of them at a time, and hands over what each sends
/// back, in the order in which they end. Children end with this process, however that ends. No thread may run that holds a lock:
/// what a child inherits is the calling thread alone.
/// \throws UsageError, InputError, OutputError  what a child threw, in its words; the others are stopped
/// \throws OutputError  a child was killed; says by which signal
void run_in_children(std::size_t count, std::size_t at_once,
                     const std::function<std::string(std::size_t, Progress&)>& work,
                     const std::function<void(std::size_t, ChildResult)>& done,
                     const std::function<std::string(std::size_t)>& name);

/// One piece of work in a child. \param name  for messages \throws as run_in_children
ChildResult run_in_child(const std::string& name, const ChildWork& work);

}  // namespace blockrand::base
