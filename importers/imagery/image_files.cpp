#include "importers/imagery/image_files.h"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/gdal/gdal_scope.h"

namespace blockrand::importers::imagery {

namespace {

ImageFile hashed(const std::string& path) {
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file(gdal::api().VSIFOpenL(path.c_str(), "rb"),
                                                           gdal::api().VSIFCloseL);
  if (!file) throw base::InputError(path, "", "cannot be read", "It belongs to an image; check its rights");
  ImageFile out{path, 0, {}};
  base::Sha256 digest;
  std::array<char, 1 << 16> buffer;
  while (const std::size_t n = gdal::api().VSIFReadL(buffer.data(), 1, buffer.size(), file.get())) {
    digest.add(std::string_view(buffer.data(), n));
    out.bytes += n;
  }
  out.sha256 = digest.finish();
  return out;
}

/// The raster's own file, then those that belong to it.
std::vector<std::string> names_of_files(const std::string& path) {
  gdal::register_drivers();
  const gdal::GdalScope quiet;
  std::vector<std::string> others;
  if (const GDALDatasetH image = gdal::api().GDALOpenEx(path.c_str(), GDAL_OF_RASTER, nullptr, nullptr, nullptr)) {
    char** const names = gdal::api().GDALGetFileList(image);
    for (char** name = names; name && *name; ++name)
      if (*name != path) others.emplace_back(*name);
    gdal::api().CSLDestroy(names);
    gdal::api().GDALClose(image);
  }
  // Drivers do not list the files beside a picture that give it its place.
  const std::size_t dot = path.find_last_of('.');
  if (dot != std::string::npos && path.find('/', dot) == std::string::npos && path.size() > dot + 2) {
    const std::string stem = path.substr(0, dot + 1), end = path.substr(dot + 1);
    for (const std::string& other : {stem + "prj", stem + "wld", path + "w", stem + end.front() + end.back() + "w"}) {
      VSIStatBufL status;
      if (other != path && gdal::api().VSIStatL(other.c_str(), &status) == 0) others.push_back(other);
    }
  }
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  std::vector<std::string> names = {path};
  for (const std::string& other : others) {
    VSIStatBufL status;
    if (gdal::api().VSIStatL(other.c_str(), &status) == 0 && !VSI_ISDIR(status.st_mode)) names.push_back(other);
  }
  return names;
}

}  // namespace

std::vector<ImageFile> files_of_image(const std::string& path) {
  std::vector<ImageFile> files;
  for (const std::string& name : names_of_files(path)) files.push_back(hashed(name));
  return files;
}

std::vector<FileStamp> stamps_of_raster(const std::string& path) {
  std::vector<FileStamp> stamps;
  for (const std::string& name : names_of_files(path)) {
    VSIStatBufL status;
    if (gdal::api().VSIStatL(name.c_str(), &status) == 0)
      stamps.push_back({name, static_cast<std::uint64_t>(status.st_size), static_cast<std::int64_t>(status.st_mtime)});
  }
  return stamps;
}

}  // namespace blockrand::importers::imagery
