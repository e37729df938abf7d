#include "pipeline/validate/glb_container.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "pipeline/validate/meshopt_view.h"

namespace blockrand::validate {
namespace {

constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

std::uint32_t word(std::string_view bytes, std::size_t at) {
  std::uint32_t v = 0;
  std::memcpy(&v, bytes.data() + at, 4);
  return v;
}

std::size_t width_of(std::string_view type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4" || type == "MAT2") return 4;
  if (type == "MAT3") return 9;
  if (type == "MAT4") return 16;
  return 0;
}

std::size_t size_of(int component_type) {
  switch (component_type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

template <class T>
double load(const char* at) {
  T v;
  std::memcpy(&v, at, sizeof(T));
  return static_cast<double>(v);
}

void collect_extensions(const Json& json, std::set<std::string>& names) {
  // An explicit stack: a damaged document may be nested as deep as it is long.
  std::vector<const Json*> open{&json};
  while (!open.empty()) {
    const Json* j = open.back();
    open.pop_back();
    if (const Json* extensions = member(*j, "extensions"); extensions && extensions->is_object())
      for (const auto& [name, value] : extensions->items()) names.insert(name);
    if (j->is_structured())
      for (const Json& child : *j) open.push_back(&child);
  }
}

}  // namespace

GlbContainer::GlbContainer(std::string_view bytes, std::string name, std::vector<Finding>& findings)
    : name_(std::move(name)), findings_(findings) {
  readable_ = open(bytes);
  if (!readable_) return;
  if (text(member(member(json_, "asset"), "version")) != "2.0") found(Check::glb_rule, "asset.version is not 2.0");
  check_extensions();
  check_views();
  check_accessors();
}

bool GlbContainer::open(std::string_view bytes) {
  const auto unreadable = [&](std::string why) {
    found(Check::file_unreadable, std::move(why));
    return false;
  };
  if (bytes.size() < 20 || bytes.substr(0, 4) != "glTF") return unreadable("no GLB header");
  if (word(bytes, 4) != 2) return unreadable(fmt::format("container version {}", word(bytes, 4)));
  if (word(bytes, 8) != bytes.size())
    return unreadable(fmt::format("the header says {} bytes, the file has {}", word(bytes, 8), bytes.size()));
  std::size_t at = 12;
  for (int chunk = 0; at < bytes.size(); ++chunk) {
    if (at + 8 > bytes.size()) return unreadable("bytes behind the last chunk");
    const std::size_t length = word(bytes, at);
    const std::uint32_t type = word(bytes, at + 4);
    if (length > bytes.size() - at - 8) return unreadable(fmt::format("chunk {} leaves the file", chunk));
    if (length % 4 != 0)
      found(Check::glb_rule, fmt::format("chunk {} is {} bytes long, no multiple of 4", chunk, length));
    const std::string_view content = bytes.substr(at + 8, length);
    if (chunk == 0) {
      if (type != kJsonChunk) return unreadable("the first chunk is not JSON");
      auto parsed = parse_json(content);
      if (!parsed || !parsed->is_object()) return unreadable("the JSON chunk cannot be parsed");
      json_ = std::move(*parsed);
    } else if (chunk == 1 && type == kBinChunk) {
      bin_ = content;
    } else if (type == kJsonChunk || type == kBinChunk) {
      found(Check::glb_rule, fmt::format("chunk {} of a type that may not stand there", chunk));
    }
    at += 8 + length;
  }
  return json_.is_object() || unreadable("no JSON chunk");
}

void GlbContainer::check_extensions() {
  const auto list = [&](const char* key) {
    std::set<std::string> names;
    if (const Json* array = member(json_, key)) {
      if (!array->is_array() || array->empty()) found(Check::glb_rule, fmt::format("{} is no list", key));
      for (const Json& name : *array) names.insert(text(&name));
    }
    return names;
  };
  const std::set<std::string> used = list("extensionsUsed"), required = list("extensionsRequired");
  std::set<std::string> there;
  collect_extensions(json_, there);
  for (const std::string& name : there)
    if (!used.count(name)) found(Check::glb_rule, name + " is not in extensionsUsed");
  for (const std::string& name : required)
    if (!used.count(name)) found(Check::glb_rule, name + " is required, but not in extensionsUsed");
}

void GlbContainer::check_views() {
  const Json* buffers = member(json_, "buffers");
  const std::size_t buffer_count = buffers && buffers->is_array() ? buffers->size() : 0;
  std::size_t length = 0;
  // The buffer that has bytes only for those who decompress.
  std::optional<std::uint64_t> unpacked_length;
  if (const Json* fallback = element(buffers, 1);
      fallback && !member(fallback, "uri") &&
      is_true(member(member(member(fallback, "extensions"), "EXT_meshopt_compression"), "fallback")))
    unpacked_length = whole(member(fallback, "byteLength"));
  if (buffer_count > 0) {
    const Json& buffer = (*buffers)[0];
    const auto said = whole(member(buffer, "byteLength"));
    if (buffer_count > (unpacked_length ? 2 : 1) || member(buffer, "uri"))
      found(Check::glb_rule, "data outside of the file");
    if (!said || *said < 1 || *said > bin_.size() || bin_.size() - *said > 3)
      found(Check::glb_rule, fmt::format("buffer of {} bytes, binary chunk of {}", said.value_or(0), bin_.size()));
    length = std::min<std::size_t>(said.value_or(0), bin_.size());
  } else if (!bin_.empty()) {
    found(Check::glb_rule, "a binary chunk without a buffer");
  }
  const Json* views = member(json_, "bufferViews");
  if (!views || !views->is_array()) return;
  for (std::size_t i = 0; i < views->size(); ++i) {
    const Json& view = (*views)[i];
    const auto buffer = whole(member(view, "buffer")), size = whole(member(view, "byteLength"));
    const Json* offset_json = member(view, "byteOffset");
    const auto offset = offset_json ? whole(offset_json) : std::optional<std::uint64_t>(0);
    views_.emplace_back();
    const Json* packed = member(member(view, "extensions"), "EXT_meshopt_compression");
    const std::uint64_t room = packed ? unpacked_length.value_or(0) : length;
    if (buffer != (packed ? 1u : 0u) || !size || *size < 1 || !offset || *offset > room || *size > room - *offset) {
      found(Check::glb_rule, fmt::format("buffer view {} leaves the buffer", i));
      continue;
    }
    if (const Json* stride = member(view, "byteStride")) {
      const auto s = whole(stride);
      if (!s || *s < 4 || *s > 252 || *s % 4 != 0) {
        found(Check::glb_rule, fmt::format("buffer view {} has a stride that is no multiple of 4 from 4 to 252", i));
        continue;
      }
    }
    if (const Json* target = member(view, "target"))
      if (const auto t = whole(target); t != 34962u && t != 34963u)
        found(Check::glb_rule, fmt::format("buffer view {} has an unknown target", i));
    if (packed) {
      std::string why;
      if (auto bytes = unpack_view(view, *packed, bin_.substr(0, length), why))
        views_.back() = unpacked_.emplace_back(std::move(*bytes));
      else
        found(Check::glb_rule, fmt::format("buffer view {} {}", i, why));
      continue;
    }
    views_.back() = bin_.substr(*offset, *size);
  }
}

void GlbContainer::check_accessors() {
  const Json* list = member(json_, "accessors");
  if (!list || !list->is_array()) return;
  const Json* views = member(json_, "bufferViews");
  for (std::size_t i = 0; i < list->size(); ++i) {
    accessors_.emplace_back();
    const Json& json = (*list)[i];
    const auto wrong = [&](const std::string& why) { found(Check::glb_rule, fmt::format("accessor {} {}", i, why)); };
    Accessor a;
    a.component_type =
        static_cast<int>(std::min<std::uint64_t>(whole(member(json, "componentType")).value_or(0), 9999));
    a.type = text(member(json, "type"));
    a.normalised = is_true(member(json, "normalized"));
    a.width = width_of(a.type);
    a.size = size_of(a.component_type);
    const auto count = whole(member(json, "count"));
    if (a.width == 0 || a.size == 0 || !count || *count < 1) {
      wrong("has no known type or no elements");
      continue;
    }
    if (a.normalised && a.component_type >= 5125) wrong("is normalised, but no small integer");
    if (member(json, "sparse")) {
      wrong("is sparse");
      continue;
    }
    a.count = *count;
    const auto bytes = view(member(json, "bufferView"));
    if (!bytes) {
      wrong("has no buffer view");
      continue;
    }
    const auto offset =
        member(json, "byteOffset") ? whole(member(json, "byteOffset")) : std::optional<std::uint64_t>(0);
    const auto own_stride = whole(member(element(views, *whole(member(json, "bufferView"))), "byteStride"));
    a.stride = own_stride.value_or(a.width * a.size);
    const std::size_t element_size = a.width * a.size;
    if (!offset || *offset > bytes->size() || a.stride < element_size || element_size > bytes->size() - *offset ||
        (a.count - 1) > (bytes->size() - *offset - element_size) / a.stride) {
      wrong("leaves its buffer view");
      continue;
    }
    a.first = bytes->data() + *offset;
    const std::size_t view_start =
        whole(member(element(views, *whole(member(json, "bufferView"))), "byteOffset")).value_or(0);
    if ((view_start + *offset) % a.size != 0 || *offset % a.size != 0 || a.stride % a.size != 0)
      wrong("is not aligned");
    check_bounds(a, json, i);
    accessors_.back() = std::move(a);
  }
}

void GlbContainer::check_bounds(const Accessor& a, const Json& json, std::size_t index) {
  std::vector<double> low(a.width, std::numeric_limits<double>::infinity()), high(a.width, -low[0]);
  bool finite = true;
  Accessor raw = a;
  raw.normalised = false;  // bounds are stated before normalisation
  const bool bounded = member(json, "min") || member(json, "max");
  if (!bounded && !a.is_float()) return;
  for (std::size_t i = 0; i < a.count; ++i)
    for (std::size_t c = 0; c < a.width; ++c) {
      const double v = value(raw, i, c);
      finite = finite && std::isfinite(v);
      low[c] = std::min(low[c], v);
      high[c] = std::max(high[c], v);
    }
  if (!finite) found(Check::glb_rule, fmt::format("accessor {} holds a value that is no finite number", index));
  if (!bounded || !finite) return;
  if (numbers(member(json, "min"), a.width) != low || numbers(member(json, "max"), a.width) != high)
    found(Check::glb_rule, fmt::format("min and max of accessor {} are not those of its values", index));
}

const GlbContainer::Accessor* GlbContainer::accessor(const Json* index) const {
  const auto i = whole(index);
  return i && *i < accessors_.size() && accessors_[*i] ? &*accessors_[*i] : nullptr;
}

double GlbContainer::value(const Accessor& a, std::size_t i, std::size_t c) const {
  const char* at = a.first + i * a.stride + c * a.size;
  double v = 0, scale = 1;
  switch (a.component_type) {
    case 5120:
      v = load<std::int8_t>(at);
      scale = 127;
      break;
    case 5121:
      v = load<std::uint8_t>(at);
      scale = 255;
      break;
    case 5122:
      v = load<std::int16_t>(at);
      scale = 32767;
      break;
    case 5123:
      v = load<std::uint16_t>(at);
      scale = 65535;
      break;
    case 5125:
      return load<std::uint32_t>(at);
    default:
      return load<float>(at);
  }
  return a.normalised ? std::max(v / scale, -1.0) : v;
}

std::optional<std::string_view> GlbContainer::view(const Json* index) const {
  const auto i = whole(index);
  return i && *i < views_.size() ? views_[*i] : std::nullopt;
}

std::size_t GlbContainer::view_offset(const Json* index) const {
  const auto i = whole(index);
  return i ? whole(member(element(member(json_, "bufferViews"), *i), "byteOffset")).value_or(0) : 0;
}

}  // namespace blockrand::validate
