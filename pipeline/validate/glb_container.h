// The container of a GLB: header, chunks, buffer views and accessors, with every access checked.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/validate/checked_json.h"
#include "pipeline/validate/finding.h"

namespace blockrand::validate {

/// Reads through a GLB in memory and notes breaches of glTF 2.0's rules on the way; buffer views that
/// EXT_meshopt_compression packed are unpacked. `bytes` must outlive it.
class GlbContainer {
 public:
  /// An accessor that lies inside of its buffer view, which lies inside of the buffer.
  struct Accessor {
    int component_type = 0;  ///< 5120 … 5126
    std::string type;        ///< "SCALAR", "VEC3" …
    bool normalised = false;
    std::size_t width = 1, size = 1;  ///< components of an element, bytes of a component
    std::size_t count = 0, stride = 0;
    const char* first = nullptr;  ///< the first element
    bool is_float() const { return component_type == 5126; }
  };

  /// \param name  of the file, for findings
  GlbContainer(std::string_view bytes, std::string name, std::vector<Finding>& findings);

  /// False where the container cannot be taken apart: nothing else may be asked then.
  bool readable() const { return readable_; }
  const Json& json() const { return json_; }
  std::string_view bin() const { return bin_; }

  std::size_t accessor_count() const { return accessors_.size(); }
  /// Null where there is none with this index, or a broken one (that was found when the container was opened).
  const Accessor* accessor(const Json* index) const;
  /// Component `c` of element `i`, decoded where normalised. Indices must be in range.
  double value(const Accessor& a, std::size_t i, std::size_t c = 0) const;

  /// The bytes of a buffer view, or nothing where it does not exist or leaves the buffer.
  std::optional<std::string_view> view(const Json* index) const;
  std::size_t view_offset(const Json* index) const;

  void found(Check check, std::string detail, std::string object = {}) const {
    findings_.push_back({check, name_, std::move(object), std::move(detail)});
  }

 private:
  bool open(std::string_view bytes);
  void check_views();
  void check_accessors();
  void check_bounds(const Accessor& a, const Json& json, std::size_t index);
  void check_extensions();

  std::string name_;
  std::vector<Finding>& findings_;
  Json json_;
  std::string_view bin_;
  bool readable_ = false;
  std::vector<std::optional<std::string_view>> views_;
  std::deque<std::string> unpacked_;  ///< what views that were compressed look at
  std::vector<std::optional<Accessor>> accessors_;
};

}  // namespace blockrand::validate
