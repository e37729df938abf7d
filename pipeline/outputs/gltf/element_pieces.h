// Elements of a tile in pieces that few draws show: which pieces are placed, and which become part of the tile's mesh.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "pipeline/model/region.h"
#include "pipeline/outputs/gltf/element_geometry.h"

namespace blockrand::outputs {

/// What one draw shows of an element: the filling of an opening, its reveal, its trim, its sill; or a connected part of
/// these in one look. About its middle, in the axes of the element.
struct Piece {
  /// Single precision: a dense tile has a million of them, and about the middle of a window it is off by less than a thousandth of a
  /// millimetre.
  struct Vector {
    float x = 0, y = 0, z = 0;
    bool operator==(const Vector&) const = default;
    operator model::Point3() const { return {x, y, z}; }
  };
  struct Vertex {
    Vector position;  ///< m
    Vector normal;    ///< unit vector
    model::PartMaterial look;
  };
  std::span<const Vertex> vertices;        ///< of a PiecePlan
  std::span<const std::uint16_t> indices;  ///< counter-clockwise triangles
  model::Point3 middle;                    ///< m, in the element's frame
  model::Point3 half;                      ///< m, half of its size; 0 where it is flat
  bool upright = false;                    ///< all normals lie along an axis: a scale along the axes turns none

  std::size_t triangles() const { return indices.size() / 3; }
};

/// Vertices and indices of pieces, in large blocks that stay where they are.
class PieceStore {
 public:
  /// Room for `count` more in one stretch; what stands there is not said.
  std::span<Piece::Vertex> add_vertices(std::size_t count) { return vertices_.add(count); }
  std::span<std::uint16_t> add_indices(std::size_t count) { return indices_.add(count); }

 private:
  template <class T>
  class Blocks {
   public:
    std::span<T> add(std::size_t count) {
      if (count > room_) {
        room_ = std::max(count, kBlock);
        // Not written to before its owner does: clearing it was a tenth of making GLBs.
        blocks_.push_back(std::make_unique_for_overwrite<std::byte[]>(room_ * sizeof(T)));
        next_ = reinterpret_cast<T*>(blocks_.back().get());
      }
      const std::span<T> out(next_, count);
      next_ += count;
      room_ -= count;
      return out;
    }

   private:
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    static_assert(alignof(T) <= __STDCPP_DEFAULT_NEW_ALIGNMENT__);
    static constexpr std::size_t kBlock = std::size_t{1} << 15;
    std::vector<std::unique_ptr<std::byte[]>> blocks_;
    T* next_ = nullptr;  // in the last block
    std::size_t room_ = 0;
  };
  Blocks<Piece::Vertex> vertices_;
  Blocks<std::uint16_t> indices_;
};

/// m. A placed piece is another one scaled along its axes. Its ends are exact, and a corner between them, the edge of a
/// glazing bar, lies no farther than this from its place.
inline constexpr double kPieceTolerance = 0.03;
/// m. The same for reveals, which meet the hole in the wall.
inline constexpr double kRevealTolerance = 0.0005;

/// A shape that is placed.
struct PlacedPiece {
  struct Place {
    const ElementInstance* at = nullptr;
    model::Point3 middle;  ///< m, in the element's frame
    model::Point3 scale;   ///< along the element's axes; 1 along an axis in which the shape is flat
  };
  Piece shape;
  std::vector<Place> places;  ///< by feature, along each wall from left to right, from below
};

/// A piece that is part of the mesh, at all places.
struct BakedPiece {
  Piece piece;
  const std::vector<ElementInstance>* places = nullptr;
};

struct PiecePlan {
  std::vector<PlacedPiece> placed;  ///< those that save the most bytes first
  std::vector<BakedPiece> baked;
  PieceStore store;  ///< what their pieces point into
};

/// Divides elements into pieces and finds equal ones, so that at most `most` shapes are placed and the file is small:
/// popular pieces are shapes, what is left is divided into connected parts, of which the popular ones (a bar, a board)
/// are shapes again, and the rest is baked. Panes are pieces of their own where they are not as modelled: they have another
/// material. \param groups  must outlive the plan
/// \param materials  of panes; null: they are as modelled
PiecePlan plan_pieces(const model::Region& region, const std::vector<InstanceGroup>& groups, std::size_t most,
                      const PaneMaterials* materials = nullptr);

/// A place and direction of a piece in east, north, up.
struct PieceTurn {
  model::Point2 along, out;
  explicit PieceTurn(const model::Point2& right) : along(right), out{right.y, -right.x} {}
  model::Point3 operator()(const model::Point3& p) const {
    return {along.x * p.x + out.x * p.z, along.y * p.x + out.y * p.z, p.y};
  }
};

}  // namespace blockrand::outputs
