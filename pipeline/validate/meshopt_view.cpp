#include "pipeline/validate/meshopt_view.h"

#include <meshoptimizer.h>

namespace blockrand::validate {
namespace {

/// No stream says more than this many times its size, so that a damaged file cannot ask for all memory: a lane of 16
/// equal bytes takes two bits.
constexpr std::uint64_t kMostExpansion = 64, kAnyway = 4096;

}  // namespace

std::optional<std::string> unpack_view(const Json& view, const Json& extension, std::string_view bin,
                                       std::string& why) {
  const auto fail = [&](const char* what) -> std::optional<std::string> {
    why = what;
    return std::nullopt;
  };
  const auto buffer = whole(member(extension, "buffer")), size = whole(member(extension, "byteLength")),
             stride = whole(member(extension, "byteStride")), count = whole(member(extension, "count"));
  const Json* offset_json = member(extension, "byteOffset");
  const auto offset = offset_json ? whole(offset_json) : std::optional<std::uint64_t>(0);
  if (buffer != 0u || !size || !offset || *offset > bin.size() || *size > bin.size() - *offset || *size == 0)
    return fail("has compressed bytes that leave the buffer");
  if (!stride || *stride == 0 || *stride > 256 || !count || *count == 0) return fail("has no stride or no elements");
  if (*count > (kMostExpansion * *size + kAnyway) / *stride)
    return fail("says that it has more elements than its bytes can hold");
  if (whole(member(view, "byteLength")) != *stride * *count) return fail("is not as long as its elements");
  if (const Json* own = member(view, "byteStride"); own && whole(own) != *stride)
    return fail("has another stride than its elements");
  const std::string mode = text(member(extension, "mode")), filter = text(member(extension, "filter"));
  std::string out(*stride * *count, '\0');
  const auto* from = reinterpret_cast<const unsigned char*>(bin.data()) + *offset;
  if (mode == "ATTRIBUTES") {
    if (*stride % 4 != 0) return fail("has a stride that is no multiple of 4");
    if (meshopt_decodeVertexBuffer(out.data(), *count, *stride, from, *size) != 0)
      return fail("cannot be decompressed");
    if (filter == "EXPONENTIAL")
      meshopt_decodeFilterExp(out.data(), *count, *stride);
    else if (!filter.empty() && filter != "NONE")
      return fail("has a filter that Blockrand does not write");
  } else if (mode == "TRIANGLES") {
    if ((*stride != 2 && *stride != 4) || *count % 3 != 0) return fail("is no list of triangles");
    if (!filter.empty() && filter != "NONE") return fail("filters indices");
    if (meshopt_decodeIndexBuffer(out.data(), *count, *stride, from, *size) != 0) return fail("cannot be decompressed");
  } else {
    return fail("has a mode that Blockrand does not write");
  }
  return out;
}

}  // namespace blockrand::validate
