#include "pipeline/validate/glb.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "pipeline/model/vector.h"
#include "pipeline/validate/glb_container.h"
#include "pipeline/validate/property_table_reader.h"

namespace blockrand::validate {
namespace {

using model::Point3;
using Accessor = GlbContainer::Accessor;

constexpr double kUnitQuaternion = 2e-4;    // of 16-bit components each is off by half a step at most
constexpr double kLargestCoordinate = 1e7;  // m; nothing of a tile is that far from its origin
constexpr double kElementSliver = 20;       // steps of an element: thinner triangles may be turned by rounding
constexpr int kDeepest = 16;                // levels of nodes
constexpr std::size_t kNoted = 20;          // breaches of one rule in one primitive: a damaged file could have millions

/// sRGB byte of a linear intensity: the transfer function of IEC 61966-2-1.
std::uint8_t srgb(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  const double s = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(s * 255));
}

class Reader {
 public:
  Reader(const GlbContainer& glb, Glb& out) : glb_(glb), out_(out) {}

  void read() {
    read_georeference();
    read_rows();
    read_scene();
    out_.objects = objects_;
  }

 private:
  void rule(std::string what) { glb_.found(Check::glb_rule, std::move(what)); }
  void metadata(std::string what) { glb_.found(Check::metadata_rule, std::move(what)); }

  void read_georeference() {
    const auto wrong = [&](std::string what) { glb_.found(Check::georeference, std::move(what)); };
    const Json* g = member(member(member(glb_.json(), "asset"), "extras"), "georeference");
    if (!g) return wrong("no asset.extras.georeference");
    GlbGeoreference& geo = out_.georeference;
    geo.crs = text(member(g, "crs"));
    geo.height_reference = text(member(g, "height_reference"));
    const Json* origin = member(g, "origin");
    const auto lon = number(member(origin, "longitude")), lat = number(member(origin, "latitude")),
               height = number(member(origin, "height"));
    const auto matrix = numbers(member(g, "local_to_ecef"), 16);
    if (geo.crs.empty() || geo.height_reference.empty()) wrong("crs or height_reference is missing");
    if (!lon || !lat || !height || !matrix) return wrong("the origin or local_to_ecef is incomplete");
    geo.longitude = *lon;
    geo.latitude = *lat;
    geo.height = *height;
    std::copy(matrix->begin(), matrix->end(), geo.local_to_ecef.begin());
    geo.present = true;
    const Matrix expected = east_north_up({*lon * kRadians, *lat * kRadians, *height});
    double metres = 0, turn = 0;
    for (std::size_t i = 0; i < 16; ++i)
      (i >= 12 ? metres : turn) = std::max(i >= 12 ? metres : turn, std::fabs(expected[i] - geo.local_to_ecef[i]));
    if (!(metres < 1e-3 && turn < 1e-9))
      wrong(fmt::format("local_to_ecef is not the frame of the origin: {:.4f} m and {:.2g} off", metres, turn));
  }

  void read_rows() {
    std::vector<TableRow> rows = read_property_table(glb_);
    std::map<std::string, int> rows_of;
    for (TableRow& row : rows) ++rows_of[row["building"]];
    Contents& c = out_.contents;
    for (TableRow& row : rows) {
      ReadBody body;
      body.building = row["building"];
      body.id = row["id"];
      if (!body.id.empty() && body.id == body.building && rows_of[body.building] > 1) body.id += ".1";
      body.attributes = std::move(row);
      if (c.buildings.empty() || c.buildings.back() != body.building) c.buildings.push_back(body.building);
      c.bodies.push_back(std::move(body));
    }
    out_.triangles.resize(c.bodies.size());
    out_.element_triangles.resize(c.bodies.size());
    buildings_.insert(c.buildings.begin(), c.buildings.end());
  }

  void read_scene() {
    const Json& json = glb_.json();
    const Json* scenes = member(json, "scenes");
    if (!scenes) return;  // nothing is drawn
    const Json* scene = element(scenes, member(json, "scene") ? whole(member(json, "scene")).value_or(~0ull) : 0);
    const Json* roots = member(scene, "nodes");
    if (!roots || !roots->is_array() || roots->empty()) return rule("the scene has no nodes");
    std::set<std::uint64_t> seen;
    for (const Json& root : *roots) read_node(whole(&root).value_or(~0ull), {}, seen);
  }

  /// Where a node hangs.
  struct Parent {
    Matrix matrix = kIdentity;
    int depth = 0;
    std::string house = {};  ///< the id of the building whose object it is; empty: none
    bool in_part = false;    ///< below the object of a part
  };

  void read_node(std::uint64_t index, const Parent& parent, std::set<std::uint64_t>& seen) {
    const Json* node = element(member(glb_.json(), "nodes"), index);
    if (!node) return rule(fmt::format("node {} does not exist", index));
    if (!seen.insert(index).second) return rule(fmt::format("node {} has two parents", index));
    if (parent.depth > kDeepest) return rule(fmt::format("node {} is nested deeper than any of ours", index));
    const auto matrix = node_matrix(*node);
    if (!matrix) return rule(fmt::format("node {} has a transform that is none", index));
    const Matrix own = parent.matrix * *matrix;
    const std::string where = fmt::format("node {}", index);
    Parent here{own, parent.depth + 1, parent.house, parent.in_part};
    const Json* extras = member(node, "extras");
    const Json *instancing = member(member(node, "extensions"), "EXT_mesh_gpu_instancing"),
               *feature = member(extras, "feature"), *id = member(extras, "id");
    objects_ = objects_ || id;
    if (id && feature && !parent.in_part) {
      here.in_part = true;
      read_part(*node, text(id), number(feature).value_or(-1), here, where);
    } else if (id) {
      here.house = read_house(*node, text(id), where);
    } else if (instancing || feature) {
      const auto placed = placed_mesh(*node, index);
      if (placed && instancing)
        out_.pieces = true, read_instances(*node, *instancing, own, *placed, where);
      else if (placed)
        add_place(*placed, number(feature).value_or(-1), own, where);
    } else if (member(node, "mesh")) {
      of_elements_ = text(member(node, "name")) == "elements";
      read_mesh(*node, own, of_elements_ ? "elements, " : "");
      of_elements_ = false;
    }
    if (const Json* children = member(node, "children"); children && children->is_array())
      for (const Json& child : *children) read_node(whole(&child).value_or(~0ull), here, seen);
  }

  void read_mesh(const Json& node, const Matrix& own, const std::string& before,
                 std::optional<std::size_t> row = std::nullopt) {
    const Json* mesh = element(member(glb_.json(), "meshes"), whole(member(&node, "mesh")).value_or(~0ull));
    const Json* primitives = member(mesh, "primitives");
    if (!primitives || !primitives->is_array() || primitives->empty())
      return rule(before + "a mesh without primitives");
    for (std::size_t p = 0; p < primitives->size(); ++p)
      read_primitive((*primitives)[p], own, fmt::format("{}primitive {}", before, p), nullptr, row);
  }

  // ---- objects: a node for each house, below it one for each part

  /// \return its id
  std::string read_house(const Json& node, const std::string& id, const std::string& where) {
    if (!buildings_.contains(id)) metadata(fmt::format("{}: no row of the table has its building {}", where, id));
    if (!houses_.insert(id).second) rule(fmt::format("{}: a second object of the building {}", where, id));
    if (text(member(&node, "name")).empty()) rule(where + ": the object of a building has no name");
    return id;
  }

  void read_part(const Json& node, const std::string& id, double row, const Parent& here, const std::string& where) {
    const auto& bodies = out_.contents.bodies;
    if (!(row >= 0) || row != std::floor(row) || row >= static_cast<double>(bodies.size()))
      return metadata(fmt::format("{}: feature id {} in a table of {} rows", where, row, bodies.size()));
    const auto at = static_cast<std::size_t>(row);
    const auto said = bodies[at].attributes.find("id");
    if (said == bodies[at].attributes.end() || said->second != id)
      metadata(fmt::format("{}: its part is {}, that of row {} another", where, id, at));
    if (bodies[at].building != here.house)
      metadata(fmt::format("{}: hangs below {}, but belongs to {}", where, here.house, bodies[at].building));
    if (!parts_.insert(at).second) rule(fmt::format("{}: a second object of the part {}", where, id));
    if (text(member(&node, "name")).empty()) rule(where + ": the object of a part has no name");
    if (member(&node, "mesh")) read_mesh(node, here.matrix, where + " ", at);
  }

  static std::optional<Matrix> node_matrix(const Json& node) {
    if (const Json* m = member(node, "matrix")) {
      const auto values = numbers(m, 16);
      if (!values) return std::nullopt;
      Matrix out{};
      std::copy(values->begin(), values->end(), out.begin());
      return out;
    }
    const auto part = [&](const char* key, std::vector<double> otherwise) {
      const Json* value = member(node, key);
      return value ? numbers(value, otherwise.size()) : std::optional(std::move(otherwise));
    };
    const auto t = part("translation", {0, 0, 0}), s = part("scale", {1, 1, 1}), r = part("rotation", {0, 0, 0, 1});
    if (!t || !s || !r) return std::nullopt;
    const auto& q = *r;
    if (std::fabs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) > 1e-6) return std::nullopt;
    return transform({(*t)[0], (*t)[1], (*t)[2]}, {q[0], q[1], q[2], q[3]}, {(*s)[0], (*s)[1], (*s)[2]});
  }

  static Matrix transform(const Point3& t, const std::array<double, 4>& q, const std::array<double, 3>& s) {
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    return {(1 - 2 * (y * y + z * z)) * s[0],
            2 * (x * y + z * w) * s[0],
            2 * (x * z - y * w) * s[0],
            0,
            2 * (x * y - z * w) * s[1],
            (1 - 2 * (x * x + z * z)) * s[1],
            2 * (y * z + x * w) * s[1],
            0,
            2 * (x * z + y * w) * s[2],
            2 * (y * z - x * w) * s[2],
            (1 - 2 * (x * x + y * y)) * s[2],
            0,
            t.x,
            t.y,
            t.z,
            1};
  }

  // ---- placed elements

  /// The element of a node, read when it is first placed.
  std::optional<std::size_t> placed_mesh(const Json& node, std::uint64_t index) {
    const auto mesh = whole(member(node, "mesh"));
    const Json* json = mesh ? element(member(glb_.json(), "meshes"), *mesh) : nullptr;
    const Json* primitives = member(json, "primitives");
    if (!primitives || !primitives->is_array() || primitives->empty()) {
      rule(fmt::format("node {} places a mesh that has no primitives", index));
      return std::nullopt;
    }
    const auto [known, added] = element_of_mesh_.try_emplace(*mesh, out_.elements.size());
    if (!added) return known->second;
    GlbElement& out = out_.elements.emplace_back();
    out.name = text(member(json, "name"));
    for (std::size_t p = 0; p < primitives->size(); ++p)
      read_primitive((*primitives)[p], kIdentity, fmt::format("mesh {} primitive {}", *mesh, p), &out);
    bool first = true;
    for (const GlbTriangle& t : out.triangles)
      for (const Point3& c : t.corners) {
        if (first) out.min = out.max = c;
        first = false;
        out.min = {std::min(out.min.x, c.x), std::min(out.min.y, c.y), std::min(out.min.z, c.z)};
        out.max = {std::max(out.max.x, c.x), std::max(out.max.y, c.y), std::max(out.max.z, c.z)};
      }
    return known->second;
  }

  void add_place(std::size_t element, double row, const Matrix& matrix, const std::string& where) {
    if (!(row >= 0) || row != std::floor(row) || row >= static_cast<double>(out_.contents.bodies.size()))
      return metadata(fmt::format("{}: feature id {} in a table of {} rows", where, row, out_.contents.bodies.size()));
    for (const double v : matrix)
      if (!(std::fabs(v) < kLargestCoordinate)) return rule(where + ": an element lies nowhere");
    out_.places.push_back({element, static_cast<std::size_t>(row), matrix});
  }

  void read_instances(const Json& node, const Json& instancing, const Matrix& own, std::size_t element_index,
                      const std::string& where) {
    if (!required("EXT_mesh_gpu_instancing")) rule(where + ": EXT_mesh_gpu_instancing is not required by the file");
    const Json* attributes = member(instancing, "attributes");
    const auto read = [&](const char* name, const char* type) -> const Accessor* {
      if (!member(attributes, name)) return nullptr;
      const Accessor* a = glb_.accessor(member(attributes, name));
      if (a && a->type == type) return a;
      rule(fmt::format("{}: {} of its instances cannot be read", where, name));
      return nullptr;
    };
    const Accessor *t = read("TRANSLATION", "VEC3"), *r = read("ROTATION", "VEC4"), *s = read("SCALE", "VEC3"),
                   *f = read("_FEATURE_ID_0", "SCALAR");
    if (!t || !r || !f) return rule(where + ": its instances lack TRANSLATION, ROTATION or _FEATURE_ID_0");
    for (const Accessor* a : {r, s, f})
      if (a && a->count != t->count)
        return rule(fmt::format("{}: {} places, but {} values of another attribute", where, t->count, a->count));
    if (!t->is_float() || (s && !s->is_float())) rule(where + ": TRANSLATION and SCALE must be floats");
    if (!r->is_float() && !(r->normalised && (r->component_type == 5120 || r->component_type == 5122)))
      rule(where + ": ROTATION is no quaternion");
    if (f->normalised) metadata(where + ": feature ids are no plain numbers");
    const Json* set = element(member(member(member(node, "extensions"), "EXT_instance_features"), "featureIds"), 0);
    if (!set) return metadata(where + ": no EXT_instance_features");
    if (whole(member(set, "attribute")) != 0u) metadata(where + ": its feature ids are not those of _FEATURE_ID_0");
    const Json* tables = member(member(member(glb_.json(), "extensions"), "EXT_structural_metadata"), "propertyTables");
    if (!element(tables, whole(member(set, "propertyTable")).value_or(~0ull)))
      metadata(where + ": its property table does not exist");
    std::set<double> different;
    std::size_t turned = 0;
    for (std::size_t i = 0; i < t->count; ++i) {
      const double x = glb_.value(*r, i, 0), y = glb_.value(*r, i, 1), z = glb_.value(*r, i, 2),
                   w = glb_.value(*r, i, 3);
      if (!(std::fabs(x * x + y * y + z * z + w * w - 1) < kUnitQuaternion) && ++turned == 1)
        rule(fmt::format("{}: the rotation of instance {} is no unit quaternion", where, i));
      const auto scale = [&](std::size_t c) { return s ? glb_.value(*s, i, c) : 1.0; };
      if (!(scale(0) > 0 && scale(1) > 0 && scale(2) > 0))
        rule(fmt::format("{}: instance {} is mirrored or flat", where, i));
      const Matrix place = transform({glb_.value(*t, i, 0), glb_.value(*t, i, 1), glb_.value(*t, i, 2)}, {x, y, z, w},
                                     {scale(0), scale(1), scale(2)});
      different.insert(glb_.value(*f, i));
      add_place(element_index, glb_.value(*f, i), own * place, fmt::format("{} instance {}", where, i));
    }
    if (const auto said = whole(member(set, "featureCount")); said != different.size())
      metadata(
          fmt::format("{}: featureCount {}, but {} different features", where, said.value_or(0), different.size()));
  }

  const Accessor* attribute(const Json& primitive, const char* name, std::size_t count, const std::string& where) {
    const Json* attributes = member(primitive, "attributes");
    const Accessor* a = glb_.accessor(member(attributes, name));
    if (!a)
      rule(fmt::format("{} has no {}", where, name));
    else if (count != 0 && a->count != count) {
      rule(fmt::format("{}: {} elements of {} for {} vertices", where, a->count, name, count));
      return nullptr;
    }
    return a;
  }

  /// \param placed  the element that the triangles are of; null for those of bodies
  /// \param row  of the part that the primitive belongs to as a whole
  void read_primitive(const Json& primitive, const Matrix& matrix, const std::string& where,
                      GlbElement* placed = nullptr, std::optional<std::size_t> row = std::nullopt) {
    if (const Json* mode = member(primitive, "mode"); mode && whole(mode) != 4u)
      return rule(where + " is no list of triangles");
    const Accessor* position = attribute(primitive, "POSITION", 0, where);
    if (!position) return;
    if (position->type != "VEC3") return rule(where + ": POSITION is no VEC3");
    const Json* position_json =
        element(member(glb_.json(), "accessors"), *whole(member(member(primitive, "attributes"), "POSITION")));
    if (!member(position_json, "min") || !member(position_json, "max")) rule(where + ": POSITION without min and max");
    if (!position->is_float() && !required("KHR_mesh_quantization"))
      rule(where + ": POSITION needs KHR_mesh_quantization");
    const std::size_t count = position->count;
    // Objects may leave normals out: readers take such meshes as flat.
    const bool flat = objects_ && !member(member(primitive, "attributes"), "NORMAL");
    const Accessor* normal = flat ? nullptr : attribute(primitive, "NORMAL", count, where);
    // Colours are those of vertices, or of the material.
    const Json* material =
        element(member(glb_.json(), "materials"), whole(member(primitive, "material")).value_or(~0ull));
    if (!material) rule(where + ": its material does not exist");
    const auto factor = numbers(member(member(material, "pbrMetallicRoughness"), "baseColorFactor"), 4);
    const Accessor* colour = factor ? nullptr : attribute(primitive, "COLOR_0", count, where);
    if (factor && member(member(primitive, "attributes"), "COLOR_0"))
      rule(where + ": its material and its vertices both have colours");
    const Accessor* feature = placed || row ? nullptr : attribute(primitive, "_FEATURE_ID_0", count, where);
    if ((placed || row) && member(member(primitive, "attributes"), "_FEATURE_ID_0"))
      metadata(where + ": the mesh of an element or part with feature ids of its own");
    if (normal && normal->type != "VEC3") rule(where + ": NORMAL is no VEC3"), normal = nullptr;
    if (colour && colour->type != "VEC3" && colour->type != "VEC4")
      rule(where + ": COLOR_0 is no colour"), colour = nullptr;
    if (colour && !colour->is_float() && !colour->normalised) rule(where + ": COLOR_0 is not normalised");
    if (feature && (feature->type != "SCALAR" || feature->normalised))
      metadata(where + ": feature ids are no plain numbers"), feature = nullptr;
    if (feature) check_features(primitive, *feature, where);
    if (normal) check_normals(*normal, where);
    const Accessor* indices = glb_.accessor(member(primitive, "indices"));
    if (!indices) return rule(where + " has no indices");
    if (indices->type != "SCALAR" || indices->is_float() || indices->normalised || indices->component_type == 5120 ||
        indices->component_type == 5122)
      return rule(where + ": its indices are no unsigned numbers");
    if (indices->count % 3 != 0) rule(fmt::format("{}: {} indices make no triangles", where, indices->count));
    std::array<std::uint8_t, 3> one{};
    // Colours of textured faces are divided by the mean of their texture.
    const auto told = numbers(member(member(material, "extras"), "texture_mean"), 3);
    std::array<double, 3> mean{1, 1, 1};
    for (std::size_t i = 0; told && i < 3; ++i) mean[i] = (*told)[i];
    for (std::size_t i = 0; factor && i < 3; ++i) one[i] = srgb((*factor)[i] * mean[i]);
    // Panes show something else than their colour; their material tells it.
    const auto modelled = numbers(member(member(material, "extras"), "colour"), 3);
    for (std::size_t i = 0; modelled && i < 3; ++i) one[i] = srgb((*modelled)[i]);
    if (modelled) colour = nullptr;
    read_triangles({*position, normal, colour, feature, *indices, one, row, mean}, matrix, where, placed);
  }

  bool required(const char* extension) const {
    const Json* list = member(glb_.json(), "extensionsRequired");
    return list && list->is_array() &&
           std::any_of(list->begin(), list->end(), [&](const Json& name) { return text(&name) == extension; });
  }

  void check_normals(const Accessor& normal, const std::string& where) {
    // Of 8-bit components each is off by half a step at most.
    const double tolerance = normal.is_float() ? 1e-4 : normal.size == 1 ? 0.87 / 127 : 0.87 / 32767;
    std::size_t off = 0;
    for (std::size_t i = 0; i < normal.count; ++i) {
      const double l = length(Point3{glb_.value(normal, i, 0), glb_.value(normal, i, 1), glb_.value(normal, i, 2)});
      if (!(std::fabs(l - 1) <= tolerance) && ++off == 1)
        rule(fmt::format("{}: normal {} has length {:.4f}", where, i, l));
    }
    if (off > 1) rule(fmt::format("{}: {} normals are not of unit length", where, off));
  }

  void check_features(const Json& primitive, const Accessor& feature, const std::string& where) {
    const Json* sets = member(member(member(primitive, "extensions"), "EXT_mesh_features"), "featureIds");
    const Json* set = element(sets, 0);
    if (!set) return metadata(where + ": no EXT_mesh_features");
    if (whole(member(set, "attribute")) != 0u) metadata(where + ": its feature ids are not those of _FEATURE_ID_0");
    const Json* tables = member(member(member(glb_.json(), "extensions"), "EXT_structural_metadata"), "propertyTables");
    if (!element(tables, whole(member(set, "propertyTable")).value_or(~0ull)))
      metadata(where + ": its property table does not exist");
    std::set<double> different;
    const std::size_t rows = out_.contents.bodies.size();
    for (std::size_t i = 0; i < feature.count; ++i) {
      const double id = glb_.value(feature, i);
      if (!(id >= 0) || id != std::floor(id) || id >= static_cast<double>(rows))
        return metadata(fmt::format("{}: feature id {} of vertex {} in a table of {} rows", where, id, i, rows));
      different.insert(id);
    }
    const auto said = whole(member(set, "featureCount"));
    if (said != different.size())
      metadata(
          fmt::format("{}: featureCount {}, but {} different features", where, said.value_or(0), different.size()));
  }

  struct Streams {
    const Accessor& position;
    const Accessor *normal, *colour, *feature;
    const Accessor& indices;
    std::array<std::uint8_t, 3> one_colour;  ///< where vertices have none
    std::optional<std::size_t> row;          ///< of all triangles, where vertices do not say
    std::array<double, 3> mean;              ///< of the texture, in linear light
  };

  void read_triangles(const Streams& s, const Matrix& matrix, const std::string& where, GlbElement* placed) {
    std::size_t bad_index = 0, two_features = 0, flat = 0, turned = 0, far = 0;
    const auto first = [&](std::size_t& counter, const std::string& what) {
      if (++counter <= kNoted) rule(where + ": " + what);
    };
    if (!s.position.is_float() && !placed) {
      const double steps = !s.position.normalised ? 1 : s.position.size == 1 ? 255 : 65535;
      out_.position_step = std::max(out_.position_step, length(Point3{matrix[0], matrix[1], matrix[2]}) / steps);
    }
    // Vertices first: most are used by several triangles.
    std::vector<Point3> points(s.position.count);
    std::vector<bool> usable(s.position.count, true);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point3 p =
          apply(matrix, {glb_.value(s.position, i, 0), glb_.value(s.position, i, 1), glb_.value(s.position, i, 2)});
      points[i] = placed ? p : Point3{p.x, 0.0 - p.z, p.y};  // y up becomes z up
      if (!(std::fabs(p.x) < kLargestCoordinate && std::fabs(p.y) < kLargestCoordinate &&
            std::fabs(p.z) < kLargestCoordinate)) {
        usable[i] = false;
        first(far, fmt::format("vertex {} lies nowhere", i));
      }
    }
    std::map<std::array<double, 3>, std::array<std::uint8_t, 3>> known_colours;
    for (std::size_t t = 0; t + 2 < s.indices.count; t += 3) {
      std::array<std::size_t, 3> corner{};
      bool good = true;
      for (std::size_t k = 0; k < 3; ++k) {
        corner[k] = static_cast<std::size_t>(glb_.value(s.indices, t + k));
        if (corner[k] >= points.size()) {
          first(bad_index, fmt::format("index {} of {} vertices", corner[k], points.size()));
          good = false;
        } else {
          good = good && usable[corner[k]];
        }
      }
      if (!good) continue;
      GlbTriangle triangle;
      for (std::size_t k = 0; k < 3; ++k) triangle.corners[k] = points[corner[k]];
      const auto& c = triangle.corners;
      const Point3 n = cross(c[1] - c[0], c[2] - c[0]);
      const double area = length(n);
      if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0] || !(area > 0)) {
        first(flat, fmt::format("triangle {} has no area", t / 3));
        continue;
      }
      if (s.normal) {
        // A sliver's own normal is rounding; others must look where their vertices say.
        const double nx = glb_.value(*s.normal, corner[0], 0), ny = glb_.value(*s.normal, corner[0], 1),
                     nz = glb_.value(*s.normal, corner[0], 2);
        const Point3 said = placed ? Point3{nx, ny, nz} : Point3{nx, 0.0 - nz, ny};
        const double longest = std::max({length(c[1] - c[0]), length(c[2] - c[1]), length(c[0] - c[2])});
        if (area / longest > (placed || of_elements_ ? kElementSliver : 0.1) &&
            n.x * said.x + n.y * said.y + n.z * said.z <= 0.5 * area)
          first(turned, fmt::format("triangle {} does not look where its normal points", t / 3));
      }
      triangle.colour = s.one_colour;
      if (s.colour) {
        const std::array<double, 3> linear{glb_.value(*s.colour, corner[0], 0), glb_.value(*s.colour, corner[0], 1),
                                           glb_.value(*s.colour, corner[0], 2)};
        auto found = known_colours.find(linear);
        if (found == known_colours.end())
          found = known_colours
                      .emplace(linear, std::array{srgb(linear[0] * s.mean[0]), srgb(linear[1] * s.mean[1]),
                                                  srgb(linear[2] * s.mean[2])})
                      .first;
        triangle.colour = found->second;
      }
      if (placed) {
        placed->triangles.push_back(triangle);
        continue;
      }
      out_.vertices.insert(out_.vertices.end(), c.begin(), c.end());
      if (s.row) out_.triangles[*s.row].push_back(triangle);
      if (!s.feature) continue;
      const double row = glb_.value(*s.feature, corner[0]);
      if (glb_.value(*s.feature, corner[1]) != row || glb_.value(*s.feature, corner[2]) != row) {
        if (++two_features <= kNoted) metadata(fmt::format("{}: triangle {} belongs to two features", where, t / 3));
        continue;
      }
      auto& to = of_elements_ ? out_.element_triangles : out_.triangles;
      if (row >= 0 && row < static_cast<double>(to.size())) to[static_cast<std::size_t>(row)].push_back(triangle);
    }
  }

  const GlbContainer& glb_;
  Glb& out_;
  std::map<std::uint64_t, std::size_t> element_of_mesh_;
  bool of_elements_ = false;         ///< the mesh that is read is of elements
  bool objects_ = false;             ///< the scene has objects of houses
  std::set<std::string> buildings_;  ///< of the table
  std::set<std::string> houses_;     ///< that have an object
  std::set<std::size_t> parts_;      ///< rows that have an object
};

}  // namespace

Glb read_glb(std::string_view bytes, const std::string& name) {
  Glb out;
  const GlbContainer container(bytes, name, out.contents.findings);
  out.readable = container.readable();
  if (out.readable) Reader(container, out).read();
  return out;
}

void append(Glb& glb, Glb&& piece) {
  const std::size_t elements = glb.elements.size(), rows = glb.contents.bodies.size();
  for (GlbPlace& place : piece.places) place.element += elements, place.row += rows;
  const auto move = [](auto& to, auto& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  };
  move(glb.contents.buildings, piece.contents.buildings);
  move(glb.contents.bodies, piece.contents.bodies);
  glb.contents.elements.merge(piece.contents.elements);
  move(glb.contents.findings, piece.contents.findings);
  move(glb.triangles, piece.triangles);
  move(glb.element_triangles, piece.element_triangles);
  move(glb.elements, piece.elements);
  move(glb.places, piece.places);
  move(glb.vertices, piece.vertices);
  glb.position_step = std::max(glb.position_step, piece.position_step);
}

std::vector<DrawnArea> drawn_areas(const Glb& glb) {
  const auto area = [](const Point3& a, const Point3& b, const Point3& c) { return length(cross(b - a, c - a)) / 2; };
  std::vector<DrawnArea> out;
  for (std::size_t i = 0; i < glb.triangles.size(); ++i) {
    double sum = 0;
    for (const auto* triangles : {&glb.triangles[i], &glb.element_triangles[i]})
      for (const GlbTriangle& t : *triangles) sum += area(t.corners[0], t.corners[1], t.corners[2]);
    out.push_back({sum, 0});
  }
  for (const GlbPlace& place : glb.places)
    for (const GlbTriangle& t : glb.elements[place.element].triangles)
      out[place.row].placed +=
          area(placed(place, t.corners[0]), placed(place, t.corners[1]), placed(place, t.corners[2]));
  for (DrawnArea& drawn : out) drawn.all += drawn.placed;
  return out;
}

}  // namespace blockrand::validate
