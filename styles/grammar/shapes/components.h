// comp(): the faces, edges, vertices … of a shape as shapes of their own, and the selectors that choose among them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "styles/grammar/shapes/shape.h"

namespace blockrand::grammar {

/// f, e, fe, v, fv, g, m, h (docs/rule_language.md §2.4).
enum class ComponentKind : std::uint8_t { faces, edges, face_edges, vertices, face_vertices, groups, materials, holes };
std::optional<ComponentKind> component_kind(std::string_view word);  ///< of "f" … "h"

/// How the new pivot and scope lie.
enum class ComponentAlignment : std::uint8_t {
  z_up,  ///< by the component: faces along their first edge with z along the normal
  none   ///< pivot kept, only size and place of the scope refitted
};

/// A selector of a block, ready to test. Expressions are the evaluator's.
struct Selector {
  enum class Kind : std::uint8_t {
    all,
    none,       // none: known, but never true here
    direction,  // top bottom left right front back, world.east …
    side,       // everything but top and bottom
    vertical,
    horizontal,
    aslant,
    nutant,
    border,
    inside,
    eave,
    hip,
    valley,
    ridge,
    street,  // street.front back left right side
    index,
    tagged,  // isTagged("…")
    uv,      // setback: uv.left right top bottom uMin uMax vMin vMax
    remainder,
    shape  // the other pieces of setback, shapeL …
  };
  enum class Space : std::uint8_t { scope, object, world };
  Kind kind = Kind::all;
  Space space = Space::scope;
  Vector3 direction;                            ///< direction, and street.* but side: in `space`
  double index = 0;                             ///< index: as the expression gave it
  std::string query;                            ///< tagged; uv and street: the part behind the dot
  ComponentKind tag_of = ComponentKind::faces;  ///< tagged: whose tags, when given
  std::string text;                             ///< as written: becomes comp.sel
};
/// The selector of a word of the language, or nothing for words that are no selectors (then they are expressions).
std::optional<Selector> selector_of_word(std::string_view word);
Selector selector_of_index(double index);
/// isTagged("query" [, e|v|f]).
Selector selector_of_tag(std::string_view query, std::string_view components = {});

/// One component, not yet a shape.
struct Component {
  std::uint32_t face = 0, loop = 0, corner = 0;  ///< where it is: the face, the edge's or vertex's (first) place in it
  std::uint32_t vertex_a = 0, vertex_b = 0;      ///< edges: from, to. Vertices: both the vertex
  Vector3 normal;                                ///< length one, or zero; in the scope's axes
  Vector3 up;                                    ///< face edges: the face's normal
  bool border = false;                           ///< has, or is, an edge with one face (or lies on one)
  Selector::Kind roof_edge = Selector::Kind::none;  ///< edges: eave, hip, valley, ridge
  std::vector<TrimPlane> trim_planes;               ///< faces: towards the neighbours, in object coordinates
  std::vector<std::uint32_t> faces;                 ///< groups, materials and connected sets: all their faces
};

/// The components of one shape. Keeps a reference to nothing: copies of the shape are cheap.
struct ComponentSplit {
  Shape parent;
  ComponentKind kind = ComponentKind::faces;
  ComponentAlignment alignment = ComponentAlignment::z_up;
  std::vector<Component> items;
};

/// All components, in order: faces as stored; edges in the order in which faces run along them; corners face by face;
/// vertices in the order of their numbers.
ComponentSplit components(const Shape& shape, ComponentKind kind,
                          ComponentAlignment alignment = ComponentAlignment::z_up);

/// True when the selector takes the component. Index selectors count from 0 among `split.items`; negative ones from the
/// end.
bool selected(const ComponentSplit& split, std::size_t item, const Selector& selector);

/// Of a direction in the scope's axes (length one): direction, side, vertical …, street and all; false for other kinds.
bool direction_selected(const Shape& shape, Vector3 normal, const Selector& selector);

/// `sel : X`: the component as a shape. Faces get trim planes towards their neighbours. `component` records are the
/// caller's: selector text, index within the selector, total.
Shape component_shape(const ComponentSplit& split, std::size_t item);

/// `sel = X`: all chosen components in one shape, aligned to the first; they keep what vertices they share. Nothing
/// when nothing is chosen.
std::optional<Shape> component_group(const ComponentSplit& split, std::span<const std::size_t> chosen);

/// `sel =: X`: the chosen ones in sets that hang together by edges (edges and corners: by vertices), in order of their
/// first.
std::vector<std::vector<std::size_t>> connected_sets(const ComponentSplit& split, std::span<const std::size_t> chosen);

/// True when a tag query (with ? and *) matches a tag, or a tag below it (docs/rule_language.md §2.6).
bool tag_matches(std::string_view query, std::string_view tag);

}  // namespace blockrand::grammar
