#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference {

std::string_view name_of(SurfaceClass surface_class) {
  switch (surface_class) {
    case SurfaceClass::ground:
      return "ground";
    case SurfaceClass::wall:
      return "wall";
    case SurfaceClass::roof:
      return "roof";
    case SurfaceClass::closure:
      return "closure";
    case SurfaceClass::outer_ceiling:
      return "outer_ceiling";
    case SurfaceClass::outer_floor:
      return "outer_floor";
    case SurfaceClass::floor:
      return "floor";
    case SurfaceClass::ceiling:
      return "ceiling";
    case SurfaceClass::interior_wall:
      return "interior_wall";
    case SurfaceClass::installation:
      return "installation";
    case SurfaceClass::room:
      return "room";
    case SurfaceClass::furniture:
      return "furniture";
  }
  return "";
}

std::string_view name_of(HeightReference reference) {
  switch (reference) {
    case HeightReference::unknown:
      return "unknown";
    case HeightReference::vertical_crs:
      return "vertical_crs";
    case HeightReference::sea_level:
      return "sea_level";
    case HeightReference::ellipsoidal:
      return "ellipsoidal";
    case HeightReference::above_local_ground:
      return "above_local_ground";
  }
  return "";
}

std::string_view name_of(NoteKind kind) {
  switch (kind) {
    case NoteKind::not_read:
      return "not_read";
    case NoteKind::crs:
      return "crs";
    case NoteKind::malformed_xml:
      return "malformed_xml";
    case NoteKind::malformed_json:
      return "malformed_json";
    case NoteKind::incomplete_building:
      return "incomplete_building";
    case NoteKind::bad_id:
      return "bad_id";
    case NoteKind::duplicate_id:
      return "duplicate_id";
    case NoteKind::missing_id:
      return "missing_id";
    case NoteKind::unresolved_link:
      return "unresolved_link";
    case NoteKind::bad_coordinates:
      return "bad_coordinates";
    case NoteKind::open_ring:
      return "open_ring";
    case NoteKind::short_ring:
      return "short_ring";
    case NoteKind::bad_value:
      return "bad_value";
    case NoteKind::unknown_element:
      return "unknown_element";
    case NoteKind::mixed_crs:
      return "mixed_crs";
    case NoteKind::outside_envelope:
      return "outside_envelope";
    case NoteKind::two_dimensional:
      return "two_dimensional";
    case NoteKind::bad_index:
      return "bad_index";
    case NoteKind::bad_hierarchy:
      return "bad_hierarchy";
  }
  return "";
}

bool is_breach(NoteKind kind) { return kind != NoteKind::not_read && kind != NoteKind::crs; }

std::size_t ReferenceModel::count(NoteKind kind) const {
  for (const Note& n : notes)
    if (n.kind == kind) return n.count;
  return 0;
}

std::size_t ReferenceModel::breaches() const {
  std::size_t sum = 0;
  for (const Note& n : notes)
    if (is_breach(n.kind)) sum += n.count;
  return sum;
}

}  // namespace blockrand::importers::reference
