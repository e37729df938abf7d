// Reads and places models.
#include "styles/elements/placed_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>

#include "pipeline/base/text.h"
#include "pipeline/model/vector.h"

namespace blockrand::elements {
namespace {

using model::Point3;

/// m². Triangles with less are nothing on the 1/1024 m grid.
constexpr double kLeastTriangle = 1e-7;

struct Bounds {
  Point3 least, most;
};

Bounds bounds_of(const model::TriangleModel& model) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Bounds b{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (const auto& t : model.triangles)
    for (const Point3& p : t.corners) {
      b.least = {std::min(b.least.x, p.x), std::min(b.least.y, p.y), std::min(b.least.z, p.z)};
      b.most = {std::max(b.most.x, p.x), std::max(b.most.y, p.y), std::max(b.most.z, p.z)};
    }
  return b;
}

std::string listed(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& w : words) out += (out.empty() ? "" : ", ") + w;
  return out;
}

/// One of some words; the first where the key is absent.
std::size_t word_of(base::TomlTable& table, const char* key, const std::vector<std::string>& words) {
  const auto word = table.text(key);
  if (!word) return 0;
  const auto found = std::find(words.begin(), words.end(), *word);
  if (found == words.end()) table.fail(key, fmt::format("cannot be \"{}\"", *word), "Known: " + listed(words));
  return static_cast<std::size_t>(found - words.begin());
}

/// The part of each material's triangles.
std::vector<Part> parts_of(base::TomlTable& table, const std::vector<std::string>& names) {
  std::vector<Part> out(names.size(), Part::panel);
  auto parts = table.table("parts");
  if (!parts) return out;
  std::vector<std::string> known;
  for (const std::string_view p : model::kElementPartNames) known.emplace_back(p);
  for (const std::string& key : parts->keys()) {
    if (std::find(names.begin(), names.end(), key) == names.end())
      parts->fail(key, "is no material of the model", "It has: " + listed(names));
    const auto part = parts->text(key);
    const auto found = std::find(known.begin(), known.end(), *part);
    if (found == known.end()) parts->fail(key, fmt::format("\"{}\" is no part", *part), "Known: " + listed(known));
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == key) out[i] = static_cast<Part>(found - known.begin());
  }
  return out;
}

}  // namespace

PlacedModel read_placed_model(base::TomlTable& table, const std::string& folder, bool opening,
                              const ModelReader& reader, std::string& path) {
  const std::string name = *table.text("model");
  const std::filesystem::path file(name);
  if (name.empty() || file.has_parent_path() || (file.extension() != ".glb" && file.extension() != ".gltf"))
    table.fail("model", "must be the name of a glTF file beside this one", "For example model = \"awning.glb\"");
  for (const char* key : {"licence", "source"})
    if (!table.has(key))
      table.fail(key, "is missing", "Say under which terms the model may be used, and where it comes from");
  if (!reader) table.fail("model", "names a model, and models are not read here", "");
  path = (std::filesystem::path(folder) / file).string();
  const model::TriangleModel read = reader(path);
  if (read.triangles.empty()) table.fail("model", "has no triangles", "Export its meshes as triangles");
  if (read.triangles.size() > kMostFaces)
    table.fail("model", fmt::format("has {} triangles; at most {} can be", read.triangles.size(), kMostFaces),
               "Simplify it");
  const Bounds box = bounds_of(read);
  PlacedModel out;
  out.width = box.most.x - box.least.x;
  out.height = box.most.y - box.least.y;
  if (!table.has("anchor") || !table.has("fit"))
    table.fail(table.has("anchor") ? "fit" : "anchor", "is missing", "Say how the model is placed: anchor and fit");
  const std::size_t anchor = word_of(table, "anchor", {"origin", "bottom_centre", "back_bottom_centre"});
  out.stretched = word_of(table, "fit", {"stretch", "keep"}) == 0;
  if (out.stretched && (model::snap(out.width) <= 0 || model::snap(out.height) <= 0))
    table.fail("fit", "cannot stretch a model without width or height", "Write fit = \"keep\"");
  out.stands_at_reveal = anchor != 0;
  Point3 origin;
  if (anchor != 0) {
    origin = {(box.least.x + box.most.x) / 2, box.least.y, (box.least.z + box.most.z) / 2};
    // What stands on the wall begins inside of it.
    if (anchor == 2) origin.z = box.least.z + (opening ? 0 : kApart);
  }
  const std::vector<Part> parts = parts_of(table, read.material_names);
  out.triangles.reserve(read.triangles.size());
  for (const auto& t : read.triangles)
    out.triangles.push_back(
        {{t.corners[0] - origin, t.corners[1] - origin, t.corners[2] - origin}, parts[t.material_name]});
  return out;
}

void add_model(MeshBuilder& builder, const PlacedModel& placed, const Request& request, double reveal) {
  const double across = placed.stretched ? request.width / placed.width : 1;
  const double up = placed.stretched ? request.height / placed.height : 1;
  const double out = placed.stands_at_reveal ? -reveal : 0;
  builder.begin_body();
  for (const PlacedModel::Triangle& t : placed.triangles) {
    std::array<Point3, 3> c = t.corners;
    for (Point3& p : c) p = model::snap(Point3{p.x * across, p.y * up, p.z + out});
    if (model::length(model::cross(c[1] - c[0], c[2] - c[0])) / 2 > kLeastTriangle) builder.face(c, t.part);
  }
}

}  // namespace blockrand::elements
