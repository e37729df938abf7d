#include "pipeline/textures/texture_files.h"

#include <webp/encode.h>

#include <cassert>
#include <stdexcept>

namespace blockrand::textures {

std::string webp(std::span<const std::uint8_t> rgb, int width, int height, int quality) {
  // Effort, 0 to 6. 4 is what the encoder itself takes.
  constexpr int kMethod = 4;
  assert(rgb.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  WebPConfig config;
  WebPPicture picture;
  if (!WebPConfigInit(&config) || !WebPPictureInit(&picture)) throw std::runtime_error("libwebp is of another version");
  config.method = kMethod;
  config.thread_level = 0;
  config.lossless = quality > 100 ? 1 : 0;
  config.quality = quality > 100 ? 75 : static_cast<float>(quality);  // without loss: effort
  picture.use_argb = config.lossless;
  picture.width = width, picture.height = height;
  WebPMemoryWriter writer;
  WebPMemoryWriterInit(&writer);
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &writer;
  const bool done = WebPPictureImportRGB(&picture, rgb.data(), width * 3) && WebPEncode(&config, &picture);
  std::string out;
  if (done) out.assign(reinterpret_cast<const char*>(writer.mem), writer.size);
  const int error = picture.error_code;
  WebPMemoryWriterClear(&writer);
  WebPPictureFree(&picture);
  if (!done) throw std::runtime_error("libwebp cannot encode a picture: its error " + std::to_string(error));
  return out;
}

}  // namespace blockrand::textures
