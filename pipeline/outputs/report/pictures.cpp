#include "pipeline/outputs/report/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <unordered_map>

#include "pipeline/base/parallel.h"
#include "pipeline/base/text.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/model/vector.h"
#include "pipeline/outputs/gltf/element_geometry.h"
#include "pipeline/outputs/gltf/mesh_buffers.h"
#include "pipeline/picture/lettering.h"
#include "pipeline/picture/lighting.h"
#include "pipeline/picture/render.h"

namespace blockrand::outputs {

namespace {

using model::Point3;
using picture::Camera;
using picture::Direction;

constexpr model::Colour kGround{214, 214, 208};
constexpr int kGroundCells = 80;  // of its mesh, along the longer side
constexpr std::size_t kGroundTriangles = 2 * (kGroundCells + 1) * (kGroundCells + 1);

/// Tiles from the densest one. Scattered villages in one picture would be specks: what lies further off is left out.
constexpr std::int64_t kWholeReach = 5, kPartReach = 3;

/// Square of the distance between two tiles in tiles; the quadtree closes at 180 degrees.
std::int64_t distance(const model::TileId& a, const model::TileId& b) {
  const std::int64_t round = std::int64_t{2} << a.level;
  std::int64_t dx = std::abs(static_cast<std::int64_t>(a.x) - static_cast<std::int64_t>(b.x));
  dx = std::min(dx, round - dx);
  const std::int64_t dy = static_cast<std::int64_t>(a.y) - static_cast<std::int64_t>(b.y);
  return dx * dx + dy * dy;
}

/// The buildings without the few that lie far from the others, which would make the rest small.
std::vector<Point3> core_points(const std::vector<PicturedBuilding>& buildings) {
  std::vector<double> xs, ys;
  for (const PicturedBuilding& b : buildings) {
    xs.push_back(b.box.centre().x);
    ys.push_back(b.box.centre().y);
  }
  std::sort(xs.begin(), xs.end());
  std::sort(ys.begin(), ys.end());
  const std::size_t cut = xs.size() / 100, last = xs.size() - 1 - cut;
  std::vector<Point3> out;
  for (const PicturedBuilding& b : buildings) {
    const Point3 c = b.box.centre();
    if (c.x < xs[cut] || c.x > xs[last] || c.y < ys[cut] || c.y > ys[last]) continue;
    for (const Point3& p : b.box.corners()) out.push_back(p);
  }
  return out;
}

/// m², of boxes: neither a shed nor a hall.
constexpr double kLeastHouse = 60, kLargestHouse = 2500;

/// An outline before its building is made.
struct Outline {
  model::Point2 centre;
  double area = 0;  ///< m², of its box
};

/// The middle of the cell that has, with its neighbours, the most outlines of the size of a house; where there is none, the most of
/// anything.
model::Point2 densest_spot(const std::vector<Outline>& outlines) {
  constexpr double kCell = 50;  // m
  using Key = std::pair<std::int64_t, std::int64_t>;
  for (const bool houses_only : {true, false}) {
    std::map<Key, std::uint64_t> cells;
    for (const Outline& b : outlines) {
      if (houses_only && (b.area < kLeastHouse || b.area > kLargestHouse)) continue;
      const model::Point2 c = b.centre;
      const Key home{static_cast<std::int64_t>(std::floor(c.x / kCell)),
                     static_cast<std::int64_t>(std::floor(c.y / kCell))};
      for (std::int64_t x = -1; x <= 1; ++x)
        for (std::int64_t y = -1; y <= 1; ++y) ++cells[{home.first + x, home.second + y}];
    }
    const auto best =
        std::max_element(cells.begin(), cells.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    if (best == cells.end()) continue;
    return {(static_cast<double>(best->first.first) + 0.5) * kCell,
            (static_cast<double>(best->first.second) + 0.5) * kCell};
  }
  return {};
}

bool within(model::Point2 p, model::Point2 spot, double reach) {
  return (p.x - spot.x) * (p.x - spot.x) + (p.y - spot.y) * (p.y - spot.y) <= reach * reach;
}

/// Where a building has no outline, nothing.
std::optional<Outline> outline_of(const footprints::FootprintStore& store, std::uint32_t building) {
  double x0 = 1e300, y0 = 1e300, x1 = -1e300, y1 = -1e300;
  store.for_each_ring(building, [&](std::span<const model::Point2> points, bool) {
    for (const model::Point2 p : points)
      x0 = std::min(x0, p.x), y0 = std::min(y0, p.y), x1 = std::max(x1, p.x), y1 = std::max(y1, p.y);
  });
  if (!(x1 > x0)) return std::nullopt;
  return Outline{{(x0 + x1) / 2, (y0 + y1) / 2}, (x1 - x0) * (y1 - y0)};
}

/// m around the densest spot: its picture shows what stands behind it as well.
constexpr double kPicturedReach = kDetailReach + 20;

bool has_detail(const model::BuildingPart& part) { return part.lod >= 3 && !part.lod3.solid.empty(); }

/// Puts what LoD3 adds into scenes.
class DetailPainter {
 public:
  explicit DetailPainter(const model::Region& region) : region_(region) {}

  /// Windows and doors as flat pieces a little before the walls of LoD2, and what stands on the roof.
  void add_flat(const model::BuildingPart& part, std::uint32_t object, picture::Scene& scene) const {
    const model::Detail& detail = part.lod3;
    std::vector<const model::ColouredElement*> element_in(detail.openings.size(), nullptr);
    for (const model::Placement& p : detail.placements)
      if (p.opening != model::kNoOpening) element_in[p.opening] = &region_.elements.at(p.element);
    for (std::size_t i = 0; i < detail.openings.size(); ++i) {
      const model::Opening& o = detail.openings[i];
      if (o.kind == model::OpeningKind::passage) continue;
      const model::Solid& solid = detail.solid;
      const auto first = detail.triangles.first[o.polygon], end = detail.triangles.first[o.polygon + 1];
      const auto wall = detail.triangles.first[o.wall];
      if (first == end || wall == detail.triangles.first[o.wall + 1]) continue;
      const auto corner = [&](std::uint32_t triangle, std::size_t k) {
        return solid.vertices[detail.triangles.triangles[triangle][k]];
      };
      const Point3 a = corner(wall, 0), out = model::unit(cross(corner(wall, 1) - a, corner(wall, 2) - a));
      const Point3 shift = out * (dot(a - corner(first, 0), out) + kBeforeWall);
      const model::Colour colour = colour_of(o, element_in[i], solid);
      for (std::uint32_t t = first; t < end; ++t)
        scene.add_outside({corner(t, 0) + shift, corner(t, 1) + shift, corner(t, 2) + shift}, colour, object);
    }
    for (const model::RoofInstallation& body : detail.roof_installations) scene.add(body.solid, body.triangles, object);
  }

  /// How many triangles add() adds at most.
  std::size_t count(const model::BuildingPart& part) {
    if (!has_detail(part)) return std::max(part.lod1_triangles.triangles.size(), part.lod2_triangles.triangles.size());
    std::size_t sum = part.lod3.triangles.triangles.size();
    for (const model::WallInstallation& body : part.lod3.installations) sum += body.triangles.triangles.size();
    for (const model::RoofInstallation& body : part.lod3.roof_installations) sum += body.triangles.triangles.size();
    for (const model::Placement& p : part.lod3.placements)
      for (const ElementGeometry::PartTriangles& piece : geometry_of(p.element).parts) sum += piece.indices.size() / 3;
    return sum;
  }

  /// Everything, or what the part has where it has no LoD3.
  void add(const model::BuildingPart& part, std::uint32_t object, picture::Scene& scene) {
    if (!has_detail(part)) {
      const bool with_roof = part.lod >= 2 && !part.lod2.empty();
      if (const model::Solid& solid = with_roof ? part.lod2 : part.lod1; !solid.empty())
        scene.add(solid, with_roof ? part.lod2_triangles : part.lod1_triangles, object);
      return;
    }
    const model::Detail& detail = part.lod3;
    scene.add_without(detail.solid, detail.triangles, hidden_faces(region_, detail, true), object);
    for (const model::WallInstallation& body : detail.installations) scene.add(body.solid, body.triangles, object);
    for (const model::RoofInstallation& body : detail.roof_installations) scene.add(body.solid, body.triangles, object);
    for (const model::Placement& p : detail.placements) {
      const model::ColouredElement& element = region_.elements.at(p.element);
      const model::Point2 out{p.along.y, -p.along.x};
      const auto placed = [&](const Point3& v) {
        return Point3{p.origin.x + p.along.x * v.x + out.x * v.z, p.origin.y + p.along.y * v.x + out.y * v.z,
                      p.origin.z + v.y};
      };
      for (const ElementGeometry::PartTriangles& piece : geometry_of(p.element).parts) {
        const model::Colour colour = element.materials[static_cast<std::size_t>(piece.part)].colour;
        const auto at = [&](std::size_t i) { return placed(piece.vertices[piece.indices[i]].position); };
        for (std::size_t i = 0; i + 2 < piece.indices.size(); i += 3)
          scene.add_outside({at(i), at(i + 1), at(i + 2)}, colour, object);
      }
    }
  }

 private:
  /// m: two surfaces in one place would flicker in the z-buffer.
  static constexpr double kBeforeWall = 0.03;

  static model::Colour colour_of(const model::Opening& opening, const model::ColouredElement* element,
                                 const model::Solid& solid) {
    if (!element) return solid.faces[opening.polygon].colour;
    const bool door = opening.kind == model::OpeningKind::door;
    return element->materials[static_cast<std::size_t>(door ? model::ElementPart::leaf : model::ElementPart::glass)]
        .colour;
  }

  const ElementGeometry& geometry_of(std::uint32_t element) {
    const model::Element& form = *region_.elements.at(element).element;
    const auto [found, added] = geometry_.try_emplace(&form);
    if (added) found->second = element_geometry(form, false);
    return found->second;
  }

  const model::Region& region_;
  std::unordered_map<const model::Element*, ElementGeometry>
      geometry_;  ///< of the forms, which come in several colours
};

/// Corners of what stands within `reach` of a spot.
std::vector<Point3> points_near(const picture::Scene& scene, model::Point2 spot, double reach) {
  std::vector<Point3> out;
  const Point3 o = scene.origin();
  for (const picture::Scene::Triangle& t : scene.triangles())
    for (const picture::Scene::Vector& v : t.corners) {
      const Point3 p{o.x + v.x, o.y + v.y, o.z + v.z};
      if ((p.x - spot.x) * (p.x - spot.x) + (p.y - spot.y) * (p.y - spot.y) <= reach * reach) out.push_back(p);
    }
  return out;
}

/// Where the overview is taken from. The sun stands at the viewer's side in the south, so that walls and shadows show.
struct View {
  double azimuth, sun;  ///< degrees
  std::string_view from, to;
};

/// Cells along a side of the shadow maps: about one for a pixel, also of what stands near by.
constexpr int kShadowMap = 1536, kNearShadowMap = 1536;

picture::Box box_around(std::span<const Point3> points) {
  picture::Box box;
  for (const Point3& p : points) box.include(p);
  return box;
}

constexpr double kElevation = 38, kFieldOfView = 30, kMargin = 0.07;
constexpr int kWidth = 1200, kHeight = 750;
constexpr int kPairWidth = 832, kPairHeight = 520;  // two stand side by side

/// The view that shows most: a long town is seen from its side. The south-west is preferred unless another is much nearer.
View best_view(std::span<const Point3> points) {
  constexpr View kViews[] = {{215, 135, "south-west", "north-east"},
                             {145, 225, "south-east", "north-west"},
                             {180, 110, "south", "north"},
                             {260, 180, "west", "east"}};
  const auto distance = [&](const View& view) {
    const Camera c = picture::fit_perspective(points, {view.azimuth, kElevation}, static_cast<double>(kWidth) / kHeight,
                                              kFieldOfView, kMargin);
    double sum = 0;
    for (const Point3& p : points)
      sum += (p.x - c.eye.x) * c.forward.x + (p.y - c.eye.y) * c.forward.y + (p.z - c.eye.z) * c.forward.z;
    return sum / static_cast<double>(points.size());
  };
  View best = kViews[0];
  double nearest = 0.93 * distance(best);
  for (const View& view : kViews)
    if (const double d = distance(view); d < nearest) {
      nearest = d;
      best = view;
    }
  return best;
}

}  // namespace

PicturePlan plan_pictures(std::span<const footprints::Shard> shards, const footprints::RepairedExtract& repaired,
                          const georef::Projection& projection, std::uint64_t budget) {
  PicturePlan plan;
  plan.chosen.assign(shards.size(), false);
  plan.near_spot.assign(shards.size(), false);
  if (shards.empty()) return plan;
  std::size_t densest = 0;
  for (std::size_t i = 0; i < shards.size(); ++i)
    if (shards[i].seeds.size() > shards[densest].seeds.size()) densest = i;
  const georef::LonLat middle = georef::centre(shards[densest].tile);
  const model::Point2 origin = projection.forward(middle.lon, middle.lat);
  plan.origin = {origin.x, origin.y, 0};

  std::vector<std::size_t> order(shards.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return distance(shards[a].tile, shards[densest].tile) < distance(shards[b].tile, shards[densest].tile);
  });
  std::uint64_t all = 0;
  for (const footprints::Shard& s : shards) all += s.seeds.size();
  const std::int64_t reach = all <= budget ? kWholeReach : kPartReach;
  for (const std::size_t i : order) {
    // The densest tile comes first and is shown in any case; a gap in the picture would look like a hole in the model.
    if (i != densest && (plan.buildings + shards[i].seeds.size() > budget ||
                         distance(shards[i].tile, shards[densest].tile) > reach * reach)) {
      plan.whole = false;
      break;
    }
    plan.chosen[i] = true;
    plan.buildings += shards[i].seeds.size();
  }
  std::vector<Outline> outlines;
  std::vector<std::size_t> shard_of;
  for (std::size_t i = 0; i < shards.size(); ++i)
    for (std::uint32_t k = 0; plan.chosen[i] && k < shards[i].seeds.size(); ++k)
      if (const auto outline = outline_of(repaired.footprints, repaired.first[i] + k)) {
        outlines.push_back(*outline);
        shard_of.push_back(i);
      }
  plan.spot = densest_spot(outlines);
  constexpr double kMargin = 30;  // m: bodies may stand beside their outline
  for (std::size_t k = 0; k < outlines.size(); ++k)
    if (within(outlines[k].centre, plan.spot, kPicturedReach + kMargin)) plan.near_spot[shard_of[k]] = true;
  return plan;
}

PictureTile picture_tile(const model::Region& region, const PicturePlan& plan, std::size_t shard) {
  PictureTile tile{picture::Scene(plan.origin), {}, picture::Scene(plan.origin), picture::Scene(plan.origin)};
  if (!plan.chosen[shard]) return tile;
  DetailPainter painter(region);
  std::vector<std::pair<const model::BuildingPart*, std::uint32_t>> in_detail;  // with the object
  for (const model::Building& building : region.buildings) {
    if (!building.owned) continue;
    const auto object = static_cast<std::uint32_t>(tile.buildings.size());
    PicturedBuilding pictured;
    pictured.ground = building.attributes.ground_height.value;
    for (const model::BuildingPart& part : building.parts) {
      const bool with_roof = part.lod >= 2 && !part.lod2.empty();
      const model::Solid& solid = with_roof ? part.lod2 : part.lod1;
      if (solid.empty()) continue;
      tile.scene.add(solid, with_roof ? part.lod2_triangles : part.lod1_triangles, object);
      for (const Point3& p : solid.vertices) pictured.box.include(p);
      if (has_detail(part)) painter.add_flat(part, object, tile.flat);
    }
    if (pictured.box.empty) continue;
    const Point3 centre = pictured.box.centre();
    if (plan.near_spot[shard] && within({centre.x, centre.y}, plan.spot, kPicturedReach) &&
        std::ranges::any_of(building.parts, has_detail)) {
      pictured.detailed = true;
      for (const model::BuildingPart& part : building.parts) in_detail.emplace_back(&part, object);
    }
    tile.buildings.push_back(pictured);
  }
  // A list that grows by itself would take three times the memory for a while.
  std::size_t triangles = 0;
  for (const auto& [part, object] : in_detail) triangles += painter.count(*part);
  tile.detail.reserve(triangles);
  for (const auto& [part, object] : in_detail) painter.add(*part, object, tile.detail);
  return tile;
}

PackedPictureTile pack_picture(PictureTile&& tile, bool kept) {
  const std::uint64_t buildings = tile.buildings.size();
  if (!kept) return {{}, buildings, {}, std::make_shared<PictureTile>(std::move(tile))};
  base::Packer packer;
  // Room at once: a text that grows has twice the room that it needs.
  std::size_t room = 1000 + tile.buildings.size() * sizeof(PicturedBuilding);
  for (const picture::Scene* scene : {&tile.scene, &tile.flat, &tile.detail})
    room += scene->triangle_count() * sizeof(picture::Scene::Triangle) +
            scene->faces().size() * sizeof(picture::Scene::Face) +
            scene->blends().size() * sizeof(picture::Scene::Blend);
  packer.bytes.reserve(room);
  packer << tile;
  std::string sha256 = base::sha256_of(packer.bytes);
  return {std::move(sha256), buildings, std::move(packer.bytes), {}};
}

void Pictures::add(PackedPictureTile&& tile) {
  if (tile.buildings > 0) tiles_.push_back(std::move(tile));
}

void Pictures::join() {
  std::vector<PictureTile> tiles;
  for (PackedPictureTile& tile : tiles_) {
    tiles.push_back(tile.as_made ? std::move(*tile.as_made) : base::unpacked<PictureTile>(tile.bytes));
    tile = {};
  }
  tiles_ = {};
  // Scenes that grew with each tile would be copied as often. `flat` and `detail` will get what lies in the ones before.
  const auto count = [&](picture::Scene PictureTile::*scene) {
    return std::accumulate(tiles.begin(), tiles.end(), std::size_t{0},
                           [&](std::size_t n, const PictureTile& t) { return n + (t.*scene).triangle_count(); });
  };
  const std::size_t bodies = count(&PictureTile::scene) + kGroundTriangles;
  scene_.reserve(bodies);
  flat_.reserve(count(&PictureTile::flat) + bodies);
  detail_.reserve(count(&PictureTile::detail));
  for (PictureTile& tile : tiles) {
    const auto first = static_cast<std::uint32_t>(buildings_.size());
    scene_.append(tile.scene, first);
    flat_.append(tile.flat, first);
    detail_.append(tile.detail, first);
    buildings_.insert(buildings_.end(), tile.buildings.begin(), tile.buildings.end());
    tile = PictureTile();
  }
}

/// One plane, or where the ground rises and falls a mesh through the grounds of the buildings.
void Pictures::lay_ground() {
  double low = buildings_[0].ground, high = low;
  picture::Box box;
  for (const PicturedBuilding& b : buildings_) {
    low = std::min(low, b.ground);
    high = std::max(high, b.ground);
    box.include(b.box.min);
    box.include(b.box.max);
  }
  if (high - low < 0.1) {
    scene_.set_ground(low, kGround);
    return;
  }
  constexpr double kBorder = 60;      // m around the buildings
  constexpr double kSmoothing = 400;  // m²: nearer than its root, neighbours weigh alike
  const double west = box.min.x - kBorder, south = box.min.y - kBorder;
  const double width = box.max.x + kBorder - west, height = box.max.y + kBorder - south;
  const double cell = std::max(width, height) / kGroundCells;
  const int columns = static_cast<int>(width / cell) + 1, rows = static_cast<int>(height / cell) + 1;
  std::vector<double> z;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      // Mean of the grounds, weighted by the inverse fourth power of the distance.
      double sum = 0, weights = 0;
      for (const PicturedBuilding& b : buildings_) {
        const Point3 c = b.box.centre();
        const double dx = c.x - (west + i * cell), dy = c.y - (south + j * cell), d = dx * dx + dy * dy + kSmoothing;
        const double w = 1 / (d * d);
        sum += b.ground * w;
        weights += w;
      }
      z.push_back(sum / weights);
    }
  const auto object = static_cast<std::uint32_t>(buildings_.size());
  const auto node = [&](int i, int j) {
    return Point3{west + i * cell, south + j * cell, z[static_cast<std::size_t>(j * (columns + 1) + i)]};
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      scene_.add_triangle({node(i, j), node(i + 1, j), node(i + 1, j + 1)}, kGround, object);
      scene_.add_triangle({node(i, j), node(i + 1, j + 1), node(i, j + 1)}, kGround, object);
    }
}

std::string Pictures::note() const {
  if (plan_.whole) return {};
  return fmt::format("The pictures show the densest part of the build: {} buildings. The whole is in the files.",
                     base::with_thousands(plan_.buildings));
}

std::vector<outputs::ReportPicture> Pictures::take(int workers, const base::Memo* memo, std::string_view attribution) {
  if (tiles_.empty()) return {};
  auto out = base::remembered<std::vector<outputs::ReportPicture>>(
      memo && !tiles_.front().sha256.empty() ? memo : nullptr, "pictures",
      [&](base::Packer& packer) {
        packer << plan_.spot << attribution;
        for (const PackedPictureTile& tile : tiles_) packer << tile.sha256;
      },
      [&] {
        join();
        return shoot(workers, attribution);
      });
  tiles_ = {};
  scene_ = flat_ = detail_ = picture::Scene(plan_.origin);
  buildings_ = {};
  return out;
}

std::vector<outputs::ReportPicture> Pictures::shoot(int workers, std::string_view attribution) {
  std::vector<outputs::ReportPicture> out;
  lay_ground();

  struct Shot {
    Camera camera;
    picture::RenderOptions options;
    std::string caption;
  };
  std::vector<Shot> shots;
  const std::vector<Point3> core = core_points(buildings_);
  const View view = best_view(core);
  const auto add = [&](std::span<const Point3> points, Direction from, double field_of_view, int width, int height,
                       std::string caption) {
    Shot shot;
    shot.options.width = width;
    shot.options.height = height;
    shot.options.sun_azimuth = view.sun;
    shot.options.shadow_map = kShadowMap;
    shot.camera = fit_perspective(points, from, static_cast<double>(width) / height, field_of_view, kMargin);
    shot.caption = std::move(caption);
    shots.push_back(std::move(shot));
  };
  add(core, {view.azimuth, kElevation}, kFieldOfView, kWidth, kHeight, fmt::format("Seen from the {}.", view.from));
  add(core, {view.azimuth + 180, kElevation}, kFieldOfView, kPairWidth, kPairHeight,
      fmt::format("The same from the {}.", view.to));
  std::vector<Point3> near = points_near(scene_, plan_.spot, kDetailReach);
  add(near.empty() ? core : near, {view.azimuth, 27}, 40, kPairWidth, kPairHeight, "Where houses stand densest.");

  // Bodies alone throw shadows and take light of the sky away, but for those of the last picture.
  picture::Lighting lighting(scene_, shots.front().options), near_by(lighting);
  std::vector<bool> in_detail;
  for (const PicturedBuilding& b : buildings_) in_detail.push_back(b.detailed);
  const bool detailed = !detail_.empty();
  flat_.append(scene_);
  if (detailed) detail_.append_without(flat_, in_detail);  // now all that the last picture shows
  scene_ = picture::Scene(plan_.origin);
  if (detailed) near_by.refine(detail_, box_around(near.empty() ? core : near), kNearShadowMap);

  out.resize(shots.size());
  base::ordered_parallel(
      shots.size(), std::min<int>(workers, 2), shots.size(),
      [&](std::size_t i) {
        const Shot& shot = shots[i];
        const bool close = i + 1 == shots.size() && detailed;
        picture::Image image =
            picture::render(close ? detail_ : flat_, shot.camera, shot.options, close ? &near_by : &lighting);
        picture::sign(image, attribution);
        out[i] = {picture::png(image), shot.options.width, shot.options.height, shot.caption};
      },
      [](std::size_t) {});
  return out;
}

}  // namespace blockrand::outputs
