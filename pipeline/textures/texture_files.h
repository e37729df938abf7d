// Pictures as WebP files; PNG files are those of pipeline/picture.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace blockrand::textures {

/// RGB pixels as WebP (RFC 9649), with loss, or without it. \param quality  0 to 100; above 100: without loss
/// \param width, height  at most 16383
/// \throws std::runtime_error  the encoder gave up
std::string webp(std::span<const std::uint8_t> rgb, int width, int height, int quality);
/// Of a square picture.
inline std::string webp(std::span<const std::uint8_t> rgb, int pixels, int quality) {
  return webp(rgb, pixels, pixels, quality);
}

}  // namespace blockrand::textures
