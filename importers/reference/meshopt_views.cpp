#include "importers/reference/meshopt_views.h"

#include <meshoptimizer.h>

#include <cstdint>

namespace blockrand::importers::reference {
namespace {

/// A stream says at most this many times its size: 16 equal bytes take two bits, and a block of 256 elements a byte.
/// A damaged file cannot ask for all memory.
constexpr std::size_t kMostExpansion = 64, kAnyway = 4096;
/// What the codec takes.
constexpr std::size_t kMostStride = 256;

/// \return false where there is no such filter for that stride
bool filter_back(const std::string& filter, std::string& bytes, std::size_t count, std::size_t stride) {
  if (filter.empty() || filter == "NONE") return true;
  if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
    meshopt_decodeFilterOct(bytes.data(), count, stride);
  else if (filter == "QUATERNION" && stride == 8)
    meshopt_decodeFilterQuat(bytes.data(), count, stride);
  else if (filter == "EXPONENTIAL" && stride % 4 == 0)
    meshopt_decodeFilterExp(bytes.data(), count, stride);
  else
    return false;
  return true;
}

}  // namespace

std::optional<std::string> unpacked_view(const Json& packed, std::span<const std::string> buffers, std::string& why) {
  const auto fail = [&](const char* what) -> std::optional<std::string> {
    why = what;
    return std::nullopt;
  };
  const auto buffer = index(member(packed, "buffer")), length = index(member(packed, "byteLength")),
             stride = index(member(packed, "byteStride")), count = index(member(packed, "count"));
  const std::size_t offset = index(member(packed, "byteOffset")).value_or(0);
  if (!buffer || *buffer >= buffers.size() || !length || offset > buffers[*buffer].size() ||
      *length > buffers[*buffer].size() - offset)
    return fail("has packed bytes that are not there");
  if (!stride || *stride == 0 || *stride > kMostStride || !count) return fail("has no stride or no count");
  if (*count > (kMostExpansion * *length + kAnyway) / *stride)
    return fail("counts more elements than its bytes can hold");
  const std::string mode = text(member(packed, "mode")), filter = text(member(packed, "filter"));
  std::string out(*stride * *count, '\0');
  if (*count == 0) return out;
  const auto* from = reinterpret_cast<const unsigned char*>(buffers[*buffer].data()) + offset;
  int code = -1;
  if (mode == "ATTRIBUTES" && *stride % 4 == 0) {
    code = meshopt_decodeVertexBuffer(out.data(), *count, *stride, from, *length);
    if (code == 0 && !filter_back(filter, out, *count, *stride)) return fail("has a filter that is not known");
  } else if (mode == "TRIANGLES" && (*stride == 2 || *stride == 4) && *count % 3 == 0) {
    code = meshopt_decodeIndexBuffer(out.data(), *count, *stride, from, *length);
  } else if (mode == "INDICES" && (*stride == 2 || *stride == 4)) {
    code = meshopt_decodeIndexSequence(out.data(), *count, *stride, from, *length);
  } else {
    return fail("is packed in a mode that is not known");
  }
  return code == 0 ? std::optional(std::move(out)) : fail("cannot be unpacked");
}

}  // namespace blockrand::importers::reference
