#include "tests/unit/importers/reference/support.h"

#include <unistd.h>
#include <zlib.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace blockrand::importers::reference::test {
namespace {

/// The ring's text with its first point once more at the end.
std::string closed(std::string_view points) {
  std::size_t end = 0;
  for (int i = 0; i < 3; ++i) end = points.find(' ', end + (i > 0 ? 1 : 0));
  return std::string(points) + " " + std::string(points.substr(0, end));
}

std::string id_attribute(std::string_view id) { return id.empty() ? "" : " gml:id=\"" + std::string(id) + "\""; }

}  // namespace

TempFolder::TempFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "reference_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for temporary files");
  folder_ = name;
}

TempFolder::~TempFolder() { std::filesystem::remove_all(folder_); }

std::string TempFolder::write(std::string_view name, std::string_view bytes) const {
  const std::string path = folder_ + "/" + std::string(name);
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

std::string TempFolder::write_gzipped(std::string_view name, const std::string& bytes) const {
  const std::string path = folder_ + "/" + std::string(name);
  const gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
  gzclose(file);
  return path;
}

std::string all_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string document(std::string_view members, std::string_view srs) {
  std::string out =
      R"(<?xml version="1.0" encoding="UTF-8"?>
<CityModel xmlns="http://www.opengis.net/citygml/2.0" xmlns:bldg="http://www.opengis.net/citygml/building/2.0"
 xmlns:gen="http://www.opengis.net/citygml/generics/2.0" xmlns:gml="http://www.opengis.net/gml"
 xmlns:xlink="http://www.w3.org/1999/xlink" xmlns:app="http://www.opengis.net/citygml/appearance/2.0"
 xmlns:tex="http://www.opengis.net/citygml/texturedsurface/2.0">
)";
  if (!srs.empty())
    out += "<gml:boundedBy><gml:Envelope srsName=\"" + std::string(srs) +
           "\" srsDimension=\"3\"></gml:Envelope></gml:boundedBy>\n";
  return out + std::string(members) + "</CityModel>\n";
}

std::string building(std::string_view id, std::string_view inside) {
  return "<cityObjectMember>\n<bldg:Building" + id_attribute(id) + ">\n" + std::string(inside) +
         "</bldg:Building></cityObjectMember>\n";
}

std::string polygon(std::string_view points, std::string_view id, std::string_view holes) {
  return "<gml:Polygon" + id_attribute(id) + "><gml:exterior><gml:LinearRing><gml:posList>" + closed(points) +
         "</gml:posList></gml:LinearRing></gml:exterior>" +
         (holes.empty() ? ""
                        : "<gml:interior><gml:LinearRing><gml:posList>" + closed(holes) +
                              "</gml:posList></gml:LinearRing></gml:interior>") +
         "</gml:Polygon>";
}

std::string surface(std::string_view element, std::string_view polygons, std::string_view id) {
  const std::string name = "bldg:" + std::string(element);
  return "<bldg:boundedBy><" + name + id_attribute(id) +
         "><bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember>" + std::string(polygons) +
         "</gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface></" + name + "></bldg:boundedBy>\n";
}

ReferenceModel read(const std::string& xml, const ReadOptions& options) {
  const TempFolder folder;
  return read_citygml(folder.write("model.gml", xml), options);
}

std::string refusal(const std::string& path, const ReadOptions& options) {
  try {
    read_citygml(path, options);
    return "read";
  } catch (const std::exception& error) {
    return error.what();
  }
}

std::string house_ground(double east, double north, double z) {
  std::string out;
  for (const auto& [dx, dy] : std::array<std::array<double, 2>, 4>{{{0, 0}, {0, 8}, {10, 8}, {10, 0}}})
    out += (out.empty() ? "" : " ") + std::to_string(east + dx) + " " + std::to_string(north + dy) + " " +
           std::to_string(z);
  return out;
}

}  // namespace blockrand::importers::reference::test
