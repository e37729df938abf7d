// What lies at a place that builds are sent to, as far as this program put it there.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>

namespace blockrand::outward {

/// Kept in a file that grows by lines while files are sent, so that a run that is killed leaves what it did, and is written anew
/// at its end. What was being sent when it was killed is in doubt: old, new, half or missing.
class TargetState {
 public:
  /// A file that is missing says that nothing is there. \throws base::InputError  it is damaged, or of a newer program
  explicit TargetState(std::string path);

  const std::map<std::string, std::string>& here() const { return here_; }  ///< path → hash of its bytes
  const std::set<std::string>& in_doubt() const { return in_doubt_; }
  /// path → since when no tileset leads to it, seconds of Unix time
  const std::map<std::string, std::int64_t>& leaving() const { return leaving_; }
  /// Hash of the build.json that lies there whole with all that it names; empty: none does.
  const std::string& build() const { return build_; }
  /// Facts of the target beside its files: "variants" → "gzip".
  std::string note(const std::string& key) const;

  /// Nothing is known to be there any more: all that was is in doubt.
  void forget();
  /// It is another place, where nothing is.
  void clear();
  /// These are about to be sent or removed. On the disk when it returns. \throws base::OutputError
  void begin(std::span<const std::string> paths);
  /// \param hash  of its bytes
  void put(const std::string& path, const std::string& hash);
  void removed(const std::string& path);
  void leaves(const std::string& path, std::int64_t since);
  void stays(const std::string& path);  ///< the build names it again
  void set_build(const std::string& hash);
  void set_note(const std::string& key, const std::string& value);
  /// Writes everything anew. \throws base::OutputError
  void save();

 private:
  void take(std::string_view line);
  void append(std::string line);
  void flush();

  std::string path_, waiting_;
  std::map<std::string, std::string> here_, notes_;
  std::set<std::string> in_doubt_;
  std::map<std::string, std::int64_t> leaving_;
  std::string build_;
  bool cleared_ = false;
};

}  // namespace blockrand::outward
