#include "importers/reference/gltf_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "importers/reference/coordinate_text.h"
#include "pipeline/base/error.h"

namespace blockrand::importers::reference {
namespace {

/// In all that is read at once, instances counted: about 2 GB of polygons. Instances multiply without end.
constexpr std::size_t kMostTriangles = 10'000'000;
/// Primitives where nodes and instances put them, and instances of a node: each costs a matrix, also without triangles.
constexpr std::size_t kMostInstances = 1'000'000;

template <std::size_t N>
std::array<double, N> numbers_or(const Json& value, std::array<double, N> fallback) {
  std::array<double, N> out{};
  for (std::size_t i = 0; i < N; ++i) {
    const auto v = number(element(value, i));
    if (!v) return fallback;
    out[i] = *v;
  }
  return out;
}

bool is_row_of_parts(const FeatureTable& table) {
  return table.column({"building"}) != nullptr && table.column({"id"}) != nullptr;
}

const FeatureTable::Column* id_column(const FeatureTable& table) {
  for (const FeatureTable::Column& c : table.columns)
    if (c.is_id) return &c;
  return table.column({"id", "gml:id", "gmlid", "building_id", "identifier", "guid", "fid", "name"});
}

std::string value_in(const FeatureTable::Column* column, std::size_t row) {
  return column != nullptr && row < column->rows.size() ? column->rows[row].value_or("") : "";
}

}  // namespace

void GltfScene::add(GltfFile& file, const std::string& path, const Matrix4& place) {
  file_ = &file;
  tables_ = read_tables(file, path, notes_);
  table_used_.assign(tables_.size(), false);
  row_owners_.assign(tables_.size(), {});
  owners_.clear();
  for (std::size_t i = 0; i < tables_.size(); ++i)
    if (is_row_of_parts(tables_[i])) add_rows(i);
  walk(place);
}

/// The building of a key, made where there is none.
/// \param key  what makes it one across files; empty: it is always another
std::size_t GltfScene::building_of(const std::string& id, int parent, const std::string& key) {
  if (!key.empty())
    if (const auto known = by_key_.find(key); known != by_key_.end()) return known->second;
  Building b;
  b.id = id;
  b.parent = parent;
  if (id.empty()) notes_.add(NoteKind::missing_id, 0, "a feature without id");
  model_.buildings.push_back(std::move(b));
  if (!key.empty()) by_key_.emplace(key, model_.buildings.size() - 1);
  return model_.buildings.size() - 1;
}

void GltfScene::add_rows(std::size_t number) {
  if (table_used_[number]) return;
  table_used_[number] = true;
  const FeatureTable& table = tables_[number];
  const bool parts = is_row_of_parts(table);
  const FeatureTable::Column *ids = parts ? table.column({"id"}) : id_column(table),
                             *owners = table.column({"building"}), *levels = table.column({"lod"});
  std::map<std::string, std::size_t> part_count;
  if (parts)
    for (std::size_t row = 0; row < table.rows; ++row) ++part_count[value_in(owners, row)];
  auto& out = row_owners_[number];
  out.reserve(table.rows);
  for (std::size_t row = 0; row < table.rows; ++row) {
    std::string id = value_in(ids, row);
    const std::string owner = parts ? value_in(owners, row) : "";
    Owner of_row;
    if (const auto level = whole_number_of(value_in(levels, row)); level && *level >= 0 && *level <= 4)
      of_row.lod = *level;
    if (parts && !(id == owner && part_count[owner] == 1)) {
      // A part that has its building's id beside others gets one of its own, as in CityGML.
      if (id == owner) id += ".1";
      const std::size_t whole = building_of(owner, -1, owner.empty() ? "" : "b" + owner);
      of_row.building = building_of(id, static_cast<int>(whole), id.empty() ? "" : "p" + owner + "\n" + id);
    } else {
      of_row.building = building_of(id, -1, id.empty() ? "" : "b" + id);
    }
    take_attributes(table, row, model_.buildings[of_row.building]);
    out.push_back(of_row);
  }
}

void GltfScene::take_attributes(const FeatureTable& table, std::size_t row, Building& b) {
  if (!b.attributes.empty()) return;  // of another tile
  for (const FeatureTable::Column& c : table.columns)
    if (const auto& value = c.rows[row]; value && !value->empty()) b.attributes.emplace_back(c.name, *value);
  const auto value = [&](std::initializer_list<std::string_view> names) { return value_in(table.column(names), row); };
  if (std::string name = value({"name"}); !name.empty()) b.names.push_back(std::move(name));
  if (std::string use = value({"function", "use"}); !use.empty()) b.functions.push_back(std::move(use));
  if (std::string use = value({"usage"}); !use.empty()) b.usages.push_back(std::move(use));
  b.class_code = value({"class"});
  b.roof_type = value({"roofType", "built_roof"});
  b.measured_height = number_of(value({"measuredHeight", "height"}));
  b.storeys_above_ground = whole_number_of(value({"storeysAboveGround", "storeys"}));
  b.storeys_below_ground = whole_number_of(value({"storeysBelowGround"}));
  b.year_of_construction = year_of(value({"yearOfConstruction"}));
  b.year_of_demolition = year_of(value({"yearOfDemolition"}));
}

std::string GltfScene::name_of_node(std::size_t node) const {
  const Json& stated = element(member(file_->json(), "nodes"), node);
  std::string name = text(member(stated, "name"));
  if (name.empty()) name = text(member(element_of(member(file_->json(), "meshes"), member(stated, "mesh")), "name"));
  return name.empty() ? "node " + std::to_string(node) : name;
}

GltfScene::Owner GltfScene::owner_of(const Feature& feature, std::size_t node) {
  if (feature.kind == Feature::Kind::row) {
    add_rows(feature.table);
    if (feature.number < row_owners_[feature.table].size()) return row_owners_[feature.table][feature.number];
    notes_.add(NoteKind::bad_index, 0, "feature " + std::to_string(feature.number) + " has no row in its table");
    return owner_of({Feature::Kind::node, 0, node}, node);
  }
  if (const auto known = owners_.find(feature); known != owners_.end()) return known->second;
  Owner out;
  const bool by_number = feature.kind == Feature::Kind::number;
  out.building = building_of(by_number ? std::to_string(feature.number) : name_of_node(node), -1, "");
  owners_.emplace(feature, out);
  return out;
}

std::optional<Matrix4> GltfScene::transform_of(const Json& node) {
  const Json& stated = member(node, "matrix");
  if (!stated.is_null()) return matrix_of(stated);
  return from_parts(numbers_or<3>(member(node, "translation"), {0, 0, 0}),
                    numbers_or<4>(member(node, "rotation"), {0, 0, 0, 1}),
                    numbers_or<3>(member(node, "scale"), {1, 1, 1}));
}

void GltfScene::walk(const Matrix4& place) {
  const Json &json = file_->json(), &nodes = member(json, "nodes"), &scenes = member(json, "scenes");
  std::vector<std::size_t> roots;
  if (length(scenes) > 0) {
    const std::size_t scene = index(member(json, "scene")).value_or(0);
    for (const Json& root : member(element(scenes, scene), "nodes"))
      if (const auto i = index(root)) roots.push_back(*i);
  } else {  // everything that no node holds
    std::vector<bool> held(length(nodes), false);
    for (std::size_t i = 0; i < held.size(); ++i)
      for (const Json& child : member(nodes[i], "children"))
        if (const auto c = index(child); c && *c < held.size()) held[*c] = true;
    for (std::size_t i = 0; i < held.size(); ++i)
      if (!held[i]) roots.push_back(i);
  }
  std::vector<bool> met(length(nodes), false);
  std::vector<std::pair<std::size_t, Matrix4>> open;
  for (std::size_t i = roots.size(); i-- > 0;) open.emplace_back(roots[i], place);
  while (!open.empty()) {
    const auto [i, parent] = open.back();
    open.pop_back();
    if (i >= met.size()) {
      notes_.add(NoteKind::bad_index, 0, "node " + std::to_string(i) + " does not exist");
      continue;
    }
    if (met[i]) {
      notes_.add(NoteKind::bad_hierarchy, 0,
                 "node " + std::to_string(i) + " stands in two places or in itself; read once");
      continue;
    }
    met[i] = true;
    const auto own = transform_of(nodes[i]);
    if (!own) {
      notes_.add(NoteKind::bad_value, 0,
                 "the matrix of node " + std::to_string(i) + " is none; it and what hangs on it is left out");
      continue;
    }
    const Matrix4 world = parent * *own;
    add_node(i, world);
    const Json& children = member(nodes[i], "children");
    for (std::size_t c = length(children); c-- > 0;)
      if (const auto child = index(children[c])) open.emplace_back(*child, world);
  }
}

std::vector<GltfScene::Instance> GltfScene::instances_of(const Json& node, const Matrix4& world) {
  const Json& extensions = member(node, "extensions");
  const Json& attributes = member(member(extensions, "EXT_mesh_gpu_instancing"), "attributes");
  if (!attributes.is_object()) return {{world, {}}};
  const auto read = [&](const char* name) -> std::optional<AccessorValues> {
    const Json& accessor = member(attributes, name);
    return accessor.is_null() ? std::nullopt : file_->accessor(accessor);
  };
  const auto translation = read("TRANSLATION"), rotation = read("ROTATION"), scale = read("SCALE");
  std::size_t count = 0;
  for (const auto* values : {&translation, &rotation, &scale})
    if (*values) count = std::max(count, (*values)->count());
  const auto at = [&]<std::size_t N>(const std::optional<AccessorValues>& values, std::size_t i,
                                     std::array<double, N> fallback) {
    if (values && values->components == N && i < values->count())
      std::copy_n(values->values.begin() + static_cast<std::ptrdiff_t>(i * N), N, fallback.begin());
    return fallback;
  };
  const Json& ids = element(member(member(extensions, "EXT_instance_features"), "featureIds"), 0);
  const auto table = index(member(ids, "propertyTable"));
  std::optional<AccessorValues> numbers;
  if (const auto set = index(member(ids, "attribute"))) numbers = read(("_FEATURE_ID_" + std::to_string(*set)).c_str());
  const auto none = index(member(ids, "nullFeatureId"));
  if (count > kMostInstances) refuse_number(kMostInstances, "instances");
  std::vector<Instance> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Instance instance{world * from_parts(at(translation, i, std::array<double, 3>{0, 0, 0}),
                                         at(rotation, i, std::array<double, 4>{0, 0, 0, 1}),
                                         at(scale, i, std::array<double, 3>{1, 1, 1})),
                      {}};
    if (ids.is_object()) {
      std::size_t feature = i;  // ids that no attribute gives count the instances
      if (numbers && i < numbers->count() && numbers->values[i * numbers->components] >= 0)
        feature = static_cast<std::size_t>(numbers->values[i * numbers->components]);
      const bool row = table && *table < tables_.size();
      if (!none || feature != *none)
        instance.features.push_back({row ? Feature::Kind::row : Feature::Kind::number, row ? *table : 0, feature});
    }
    out.push_back(std::move(instance));
  }
  return out;
}

void GltfScene::add_node(std::size_t node, const Matrix4& world) {
  const Json& stated = element(member(file_->json(), "nodes"), node);
  const Json& number_of_mesh = member(stated, "mesh");
  if (number_of_mesh.is_null()) return;
  const Json& mesh = element_of(member(file_->json(), "meshes"), number_of_mesh);
  if (mesh.is_null()) {
    notes_.add(NoteKind::bad_index, 0, "the mesh of node " + std::to_string(node) + " does not exist");
    return;
  }
  std::vector<Instance> instances = instances_of(stated, world);
  if (const auto row = row_of_node(stated); row && instances.size() == 1 && instances[0].features.empty())
    instances[0].features.push_back({Feature::Kind::row, 0, *row});
  for (const Json& primitive : member(mesh, "primitives")) {
    if ((placed_primitives_ += instances.size()) > kMostInstances) refuse_number(kMostInstances, "instances");
    if (!instances.empty()) count_triangles(primitive, instances.size());
  }
  for (const Instance& instance : instances)
    for (const Json& primitive : member(mesh, "primitives")) add_primitive(primitive, node, instance);
}

/// Our own files say in `extras.feature` which row of the first table a node shows, where the mesh cannot.
std::optional<std::size_t> GltfScene::row_of_node(const Json& node) const {
  const auto row = index(member(member(node, "extras"), "feature"));
  const bool known = row && !tables_.empty() && is_row_of_parts(tables_[0]) && *row < tables_[0].rows;
  return known ? row : std::nullopt;
}

void GltfScene::refuse_number(std::size_t most, const std::string& what) const {
  throw base::InputError(model_.path, "", "has more than " + std::to_string(most) + " " + what,
                         "Split it, or name a part of it; a file of a few megabytes with so many is damaged");
}

/// Before any is made. Corners that an accessor states without having them do not count: it will not be read.
void GltfScene::count_triangles(const Json& primitive, std::size_t instances) {
  const Json& indices = member(primitive, "indices");
  const auto corners =
      file_->accessor_count(indices.is_null() ? member(member(primitive, "attributes"), "POSITION") : indices);
  constexpr std::size_t kStrip = 5, kFan = 6;
  const std::size_t mode = index(member(primitive, "mode")).value_or(4);
  const std::size_t triangles = mode == kStrip || mode == kFan ? corners : corners / 3;
  if (triangles > (kMostTriangles - placed_triangles_) / instances) refuse_number(kMostTriangles, "triangles");
  placed_triangles_ += triangles * instances;
}

std::vector<GltfScene::Feature> GltfScene::features_of(const Json& primitive, std::size_t vertices) {
  const Json& attributes = member(primitive, "attributes");
  const Json& sets = member(member(member(primitive, "extensions"), "EXT_mesh_features"), "featureIds");
  // The set with a table says more than one without.
  const Json* chosen = &element(sets, 0);
  for (std::size_t i = 0; i < length(sets); ++i)
    if (!member(sets[i], "propertyTable").is_null()) {
      chosen = &sets[i];
      break;
    }
  const auto table = index(member(*chosen, "propertyTable"));
  const bool row = table && *table < tables_.size();
  if (table && !row) notes_.add(NoteKind::bad_index, 0, "property table " + std::to_string(*table) + " does not exist");
  std::string name;
  if (const auto set = index(member(*chosen, "attribute"))) {
    name = "_FEATURE_ID_" + std::to_string(*set);
  } else if (chosen->is_object()) {
    if (!member(*chosen, "texture").is_null()) {
      notes_.add(NoteKind::not_read, 0, "feature ids in a texture");
      return {};
    }
    std::vector<Feature> out;  // each vertex is its own feature
    for (std::size_t i = 0; i < vertices; ++i)
      out.push_back({row ? Feature::Kind::row : Feature::Kind::number, row ? *table : 0, i});
    return out;
  } else {
    for (const char* known : {"_FEATURE_ID_0", "_BATCHID", "BATCHID"})
      if (name.empty() && !member(attributes, known).is_null()) name = known;
    if (name.empty()) return {};
  }
  const auto values = file_->accessor(member(attributes, name.c_str()));
  if (!values || values->count() < vertices) {
    if (values) notes_.add(NoteKind::bad_index, 0, name + " has fewer values than there are vertices");
    return {};
  }
  const auto none = index(member(*chosen, "nullFeatureId"));
  std::vector<Feature> out;
  out.reserve(vertices);
  for (std::size_t i = 0; i < vertices; ++i) {
    const double value = values->values[i * values->components];
    if (!(value >= 0 && value < 9e15) || (none && value == static_cast<double>(*none))) {
      out.push_back({});
    } else {
      out.push_back(
          {row ? Feature::Kind::row : Feature::Kind::number, row ? *table : 0, static_cast<std::size_t>(value)});
    }
  }
  return out;
}

/// Three vertices for each, counter-clockwise from outside; what is no triangle is noted.
std::vector<std::size_t> GltfScene::triangles_of(const Json& primitive, std::size_t vertices) {
  constexpr std::size_t kTriangles = 4, kStrip = 5, kFan = 6;
  const std::size_t mode = index(member(primitive, "mode")).value_or(kTriangles);
  if (mode != kTriangles && mode != kStrip && mode != kFan) {
    notes_.add(NoteKind::not_read, 0, mode < kTriangles ? "points or lines" : "a primitive of no known mode");
    return {};
  }
  std::vector<std::size_t> corners;
  if (const Json& stated = member(primitive, "indices"); !stated.is_null()) {
    const auto indices = file_->accessor(stated);
    if (!indices) return {};
    corners.reserve(indices->values.size());
    for (const double i : indices->values)
      corners.push_back(i >= 0 && i < static_cast<double>(vertices) ? static_cast<std::size_t>(i) : vertices);
  } else {
    for (std::size_t i = 0; i < vertices; ++i) corners.push_back(i);
  }
  std::vector<std::size_t> out;
  std::size_t bad = 0;
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    if (a >= vertices || b >= vertices || c >= vertices) {
      ++bad;
    } else if (a != b && b != c && c != a) {
      out.insert(out.end(), {a, b, c});
    }
  };
  for (std::size_t i = 0; i + 2 < corners.size(); i += mode == kTriangles ? 3 : 1) {
    if (mode == kFan) {
      add(corners[0], corners[i + 1], corners[i + 2]);
    } else if (mode == kStrip && i % 2 == 1) {
      add(corners[i + 1], corners[i], corners[i + 2]);
    } else {
      add(corners[i], corners[i + 1], corners[i + 2]);
    }
  }
  if (bad > 0) notes_.add(NoteKind::bad_index, 0, std::to_string(bad) + " triangles with a vertex that does not exist");
  return out;
}

std::optional<model::Colour> GltfScene::colour_of(const Json& material) const {
  const auto number = index(material);
  if (!number) return std::nullopt;
  const Json& factor =
      member(member(element(member(file_->json(), "materials"), *number), "pbrMetallicRoughness"), "baseColorFactor");
  if (length(factor) < 3) return model::Colour{255, 255, 255};  // the default of the format
  // Factors are linear, colours sRGB (IEC 61966-2-1).
  const auto byte = [&](std::size_t i) {
    const double linear = std::clamp(factor[i].is_number() ? factor[i].get<double>() : 1.0, 0.0, 1.0);
    const double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::floor(encoded * 255 + 0.5));
  };
  return model::Colour{byte(0), byte(1), byte(2)};
}

void GltfScene::add_primitive(const Json& primitive, std::size_t node, const Instance& instance) {
  const auto positions = file_->accessor(member(member(primitive, "attributes"), "POSITION"));
  if (!positions || positions->components != 3) return;
  const std::size_t vertices = positions->count();
  const std::vector<std::size_t> corners = triangles_of(primitive, vertices);
  const std::vector<Feature> features =
      instance.features.empty() ? features_of(primitive, vertices) : std::vector<Feature>();
  std::vector<model::Point3> points(vertices);
  for (std::size_t i = 0; i < vertices; ++i)
    points[i] = apply(instance.transform,
                      {positions->values[3 * i], positions->values[3 * i + 1], positions->values[3 * i + 2]});
  const bool turned = mirrors(instance.transform);
  const std::optional<model::Colour> colour = colour_of(member(primitive, "material"));
  Feature last;
  std::optional<Owner> owner;
  std::size_t bad = 0;
  for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
    const model::Point3 &a = points[corners[t]], &b = points[corners[t + (turned ? 2 : 1)]],
                        &c = points[corners[t + (turned ? 1 : 2)]];
    const double sum = a.x + a.y + a.z + b.x + b.y + b.z + c.x + c.y + c.z;
    if (!std::isfinite(sum)) {
      ++bad;
      continue;
    }
    if (a == b || b == c || c == a) continue;  // of strips and rounded meshes: nothing to see
    Feature feature = !instance.features.empty() ? instance.features[0]
                      : features.empty()         ? Feature()
                                                 : features[corners[t]];
    if (feature.kind == Feature::Kind::node) feature.number = node;
    if (!owner || feature != last) owner = owner_of(feature, node);
    last = feature;
    auto& geometries = model_.buildings[owner->building].geometries;
    if (geometries.empty()) {
      Geometry g;
      g.lod = owner->lod;
      g.kind = g.lod == 0 ? GeometryKind::footprint : GeometryKind::surfaces;
      geometries.push_back(std::move(g));
    }
    geometries[0].faces.push_back({static_cast<std::uint32_t>(model_.polygons.size()), false});
    geometries[0].outer_faces = geometries[0].faces.size();
    model_.polygons.push_back({{}, {a, b, c}, {}, colour});
  }
  if (bad > 0)
    notes_.add(NoteKind::bad_coordinates, 0, std::to_string(bad) + " triangles with a corner that is no point");
}

}  // namespace blockrand::importers::reference
