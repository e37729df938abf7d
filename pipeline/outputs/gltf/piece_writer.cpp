#include "pipeline/outputs/gltf/piece_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "pipeline/model/vector.h"
#include "pipeline/outputs/gltf/glb_document.h"
#include "pipeline/outputs/gltf/linear_light.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

using model::Point3;

constexpr double kPlaceSteps = kTileStepsPerMetre;
constexpr double kCube = 16384;       ///< half the edge of the cube that upright shapes fill
constexpr double kMostSteps = 32767;  ///< of a 16-bit position
constexpr double kScaleSteps = 131072;
/// Of an axis in which a shape of the cube is flat. Others reach through the whole cube: readers that take the bounds of
/// the accessor for its own are off by a millimetre then.
constexpr double kFlatScale = 1.0 / 16384;

std::array<double, 3> values(const Point3& p) { return {p.x, p.y, p.z}; }

/// Vertices of shapes that share their accessors.
struct Block {
  bool glass = false;  ///< no classes are looked up
  std::vector<std::int16_t> positions;
  std::vector<std::int8_t> normals;
  std::vector<std::uint16_t> colours, classes;
  std::size_t count = 0;
};

class PieceWriter {
 public:
  PieceWriter(GlbDocument& document, int material, const MaterialTable& materials, std::size_t rows,
              const PaneMaterials* panes)
      : document_(document), material_(material), materials_(materials), panes_(panes), wide_features_(rows > 0xFFFF) {}

  void write(const PiecePlan& plan) {
    if (plan.placed.empty()) return;
    struct Shown {
      const PlacedPiece* piece;
      Point3 units;       ///< of a position in a metre of the shape
      std::size_t block;  ///< into `blocks`
      std::size_t first;  ///< byte of its indices
    };
    std::vector<Block> blocks;
    std::vector<Shown> shown;
    // Upright shapes share a block; of the others those with the same steps a metre, whose largest extents are within a factor of
    // two: readers that take an accessor's bounds for one shape's see it as large as the largest of them.
    std::map<std::pair<bool, double>, std::size_t> open_block;  // of glass or not, by steps a metre; 0: upright ones
    for (const PlacedPiece& piece : plan.placed) {
      const Piece& shape = piece.shape;
      const Point3 units = units_of(shape);
      const bool glass = is_glass(shape);
      const auto [place, added] = open_block.try_emplace({glass, shape.upright ? 0 : units.x}, blocks.size());
      if (added || blocks[place->second].count + shape.vertices.size() > ElementGeometry::kMostVertices) {
        place->second = blocks.size();
        blocks.emplace_back().glass = glass;
      }
      const std::size_t block = place->second;
      const std::size_t first = add_shape(shape, units, blocks[block]);
      shown.push_back({&piece, units, block, first});
    }
    std::vector<std::string> attributes;
    for (const Block& block : blocks) attributes.push_back(add_block(block));
    std::string children;
    for (const Shown& s : shown) {
      if (!children.empty()) children += ',';
      append_number(children, std::int64_t{add_node(*s.piece, s.units, attributes[s.block], s.first)});
    }
    std::string json = "{\"children\":[" + children + "],\"scale\":[";
    for (int i = 0; i < 3; ++i) {
      if (i) json += ',';
      append_number(json, 1 / kPlaceSteps);
    }
    document_.add_root(document_.add_node(json + "]}"));
    document_.use("EXT_mesh_gpu_instancing", true);
    document_.use("EXT_instance_features", false);
    document_.use("KHR_mesh_quantization", true);
  }

 private:
  /// Pieces of panes have one material.
  bool is_glass(const Piece& shape) const { return panes_ && panes_->is_glass(shape.vertices[0].look.material); }

  static Point3 units_of(const Piece& shape) {
    const Point3& h = shape.half;
    if (shape.upright) {
      const auto fill = [](double half) { return half > 0 ? kCube / half : 1; };
      return {fill(h.x), fill(h.y), fill(h.z)};
    }
    double units = kPlaceSteps;
    const double most = std::max({h.x, h.y, h.z});
    while (most * units > kMostSteps) units /= 2;
    while (most * units * 2 <= kMostSteps) units *= 2;
    return {units, units, units};
  }

  /// \return the first byte of its indices
  std::size_t add_shape(const Piece& shape, const Point3& units, Block& block) {
    std::vector<std::uint16_t> indices;
    for (const std::uint32_t i : shape.indices) indices.push_back(static_cast<std::uint16_t>(block.count + i));
    for (const Piece::Vertex& v : shape.vertices) {
      for (const double p : {v.position.x * units.x, v.position.y * units.y, v.position.z * units.z, 0.0})
        block.positions.push_back(static_cast<std::int16_t>(std::nearbyint(p)));
      for (const float n : {v.normal.x, v.normal.y, v.normal.z, 0.0F})
        block.normals.push_back(static_cast<std::int8_t>(std::nearbyint(double{n} * 127)));
      const model::Colour& c = v.look.colour;
      block.colours.insert(block.colours.end(),
                           {kLinearLight[c.r], kLinearLight[c.g], kLinearLight[c.b], std::uint16_t{65535}});
      if (block.glass) continue;
      const std::array<std::uint16_t, 2> place = materials_.place(v.look.material);
      block.classes.insert(block.classes.end(), place.begin(), place.end());
    }
    block.count += shape.vertices.size();
    return document_.append<std::uint16_t>(Stream::indices, indices);
  }

  std::string add_block(const Block& block) {
    std::array<std::array<double, 3>, 2> bounds{};
    for (std::size_t i = 0; i < block.count; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double p = block.positions[4 * i + k];
        bounds[0][k] = i ? std::min(bounds[0][k], p) : p;
        bounds[1][k] = i ? std::max(bounds[1][k], p) : p;
      }
    std::string json;
    const auto add = [&]<class T>(const char* name, Stream stream, const std::vector<T>& list, Component component,
                                  const char* type, bool normalised) {
      const std::size_t at = document_.append<T>(stream, list);
      GlbAccessor accessor{.stream = stream,
                           .offset = at,
                           .component = component,
                           .type = type,
                           .count = block.count,
                           .normalised = normalised};
      if (stream == Stream::element_positions) accessor.bounds = bounds;
      json += json.empty() ? "\"" : ",\"";
      json += name;
      json += "\":";
      append_number(json, std::int64_t{document_.add_accessor(accessor)});
    };
    add("COLOR_0", Stream::colours, block.colours, Component::uint16, "VEC4", true);
    add("NORMAL", Stream::normals, block.normals, Component::int8, "VEC3", true);
    add("POSITION", Stream::element_positions, block.positions, Component::int16, "VEC3", false);
    if (!block.glass) add("TEXCOORD_0", Stream::texture_places, block.classes, Component::uint16, "VEC2", true);
    return json;
  }

  int add_node(const PlacedPiece& piece, const Point3& units, const std::string& attributes, std::size_t first_index) {
    const int indices = document_.add_accessor({.stream = Stream::indices,
                                                .offset = first_index,
                                                .component = Component::uint16,
                                                .type = "SCALAR",
                                                .count = piece.shape.indices.size()});
    std::string mesh = "{\"primitives\":[{\"attributes\":{" + attributes + "},\"indices\":";
    append_number(mesh, std::int64_t{indices});
    mesh += ",\"material\":";
    const std::uint8_t look = piece.shape.vertices[0].look.material;
    append_number(mesh, std::int64_t{is_glass(piece.shape) ? document_.add_material(panes_->glass_json(
                                                                 look, std::nullopt, MaterialName::plain))
                                                           : material_});
    const int number = document_.add_mesh(mesh + "}]}");

    const std::size_t n = piece.places.size();
    std::vector<float> translations, scales, wide;
    std::vector<std::int16_t> rotations;
    std::vector<std::uint16_t> narrow;
    std::set<std::uint32_t> rows;
    bool far = false;
    for (const PlacedPiece::Place& place : piece.places) {
      const PieceTurn turn(place.at->along);
      const Point3 p = place.at->origin + turn(place.middle);
      for (const double v : {p.x, p.z, 0.0 - p.y}) {  // y up
        translations.push_back(static_cast<float>(std::nearbyint(v * kPlaceSteps)) + 0.0f);
        far = far || std::fabs(v) > kFinestReach;
      }
      for (const double v : rotation_to(place.at->along))
        rotations.push_back(static_cast<std::int16_t>(std::nearbyint(v * 32767)));
      for (std::size_t k = 0; k < 3; ++k) {
        const bool flat = !(values(piece.shape.half)[k] > 0);
        const double scale =
            flat ? (piece.shape.upright ? kFlatScale : 1) : values(place.scale)[k] * kPlaceSteps / values(units)[k];
        scales.push_back(static_cast<float>(std::max(1.0, std::nearbyint(scale * kScaleSteps)) / kScaleSteps));
      }
      rows.insert(place.at->feature);
      if (wide_features_)
        wide.push_back(static_cast<float>(place.at->feature));
      else
        narrow.push_back(static_cast<std::uint16_t>(place.at->feature));
    }
    std::string json = "{\"extensions\":{\"EXT_instance_features\":{\"featureIds\":[{\"attribute\":0,\"featureCount\":";
    append_number(json, static_cast<std::int64_t>(rows.size()));
    json += ",\"propertyTable\":0}]},\"EXT_mesh_gpu_instancing\":{\"attributes\":{";
    const auto add = [&]<class T>(const char* name, Stream stream, const std::vector<T>& list, Component component,
                                  const char* type, bool normalised) {
      const std::size_t at = document_.append<T>(stream, list);
      if (json.back() != '{') json += ',';
      json += '"';
      json += name;
      json += "\":";
      append_number(json, std::int64_t{document_.add_accessor({.stream = stream,
                                                               .offset = at,
                                                               .component = component,
                                                               .type = type,
                                                               .count = n,
                                                               .normalised = normalised})});
    };
    add("ROTATION", Stream::rotations, rotations, Component::int16, "VEC4", true);
    add("SCALE", Stream::piece_scales, scales, Component::float32, "VEC3", false);
    add("TRANSLATION", far ? Stream::far_translations : Stream::translations, translations, Component::float32, "VEC3",
        false);
    if (wide_features_)
      add("_FEATURE_ID_0", Stream::wide_instance_features, wide, Component::float32, "SCALAR", false);
    else
      add("_FEATURE_ID_0", Stream::instance_features, narrow, Component::uint16, "SCALAR", false);
    json += "}}},\"mesh\":";
    append_number(json, std::int64_t{number});
    return document_.add_node(json + '}');
  }

  GlbDocument& document_;
  int material_;
  const MaterialTable& materials_;
  const PaneMaterials* panes_;
  bool wide_features_;
};

}  // namespace

InstanceFigures write_pieces(GlbDocument& document, const model::Region& region,
                             const std::vector<InstanceGroup>& groups, const PiecePlan& plan, int material,
                             const MaterialTable& materials, std::size_t rows, const PaneMaterials* panes) {
  PieceWriter(document, material, materials, rows, panes).write(plan);
  InstanceFigures out;
  out.elements = plan.placed.size();
  for (const PlacedPiece& piece : plan.placed) out.triangles += piece.shape.triangles() * piece.places.size();
  bool first = true;
  for (const InstanceGroup& group : groups) {
    const auto box = element_box(*region.elements.at(group.element).element, true);
    if (!box) continue;
    out.places += group.instances.size();
    for (const ElementInstance& at : group.instances)
      widen(out, at, box->first, box->second, std::exchange(first, false));
  }
  return out;
}

}  // namespace blockrand::outputs
