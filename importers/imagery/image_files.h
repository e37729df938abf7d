// The files that an image is made of, and what is in them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace blockrand::importers::imagery {

struct ImageFile {
  std::string path;  ///< as GDAL names it, perhaps within an archive
  std::uint64_t bytes = 0;
  std::string sha256;
};

/// A file's size and time of its last change, which say cheaply whether it is the same.
struct FileStamp {
  std::string path;
  std::uint64_t bytes = 0;
  std::int64_t changed = 0;  ///< seconds since 1970
};

/// Of the files that files_of_image() lists, without reading them; of any raster, a terrain as well.
std::vector<FileStamp> stamps_of_raster(const std::string& path);

/// The image's own file, then those that belong to it, by path: world file, .prj, side file, the rasters of a .vrt.
/// \throws base::InputError  one of them cannot be read
std::vector<ImageFile> files_of_image(const std::string& path);

}  // namespace blockrand::importers::imagery
