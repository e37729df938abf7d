#include "pipeline/validate/citygml_names.h"

#include <unordered_set>

namespace blockrand::validate {
namespace {

struct SurfaceName {
  std::string_view element, kind;
};
constexpr SurfaceName kSurfaces[] = {
    {"GroundSurface", "ground"},
    {"WallSurface", "wall"},
    {"RoofSurface", "roof"},
    {"OuterCeilingSurface", "outer_ceiling"},
    {"OuterFloorSurface", "outer_floor"},
    {"ClosureSurface", "closure"},
};
constexpr SurfaceName kOpenings[] = {{"Window", "window"}, {"Door", "door"}};

}  // namespace

std::string_view surface_kind(std::string_view element) {
  for (const SurfaceName& s : kSurfaces)
    if (s.element == element) return s.kind;
  return {};
}

std::string_view opening_kind(std::string_view element) {
  for (const SurfaceName& s : kOpenings)
    if (s.element == element) return s.kind;
  return {};
}

bool known_element(std::string_view space, std::string_view name) {
  using Names = std::unordered_set<std::string_view>;
  static const Names gml = {"description", "name",         "boundedBy",     "Envelope", "lowerCorner",
                            "upperCorner", "MultiSurface", "surfaceMember", "Polygon",  "exterior",
                            "interior",    "LinearRing",   "posList",       "Solid",    "CompositeSurface",
                            "Point",       "pos"};
  static const Names core = {"CityModel",         "cityObjectMember",
                             "externalReference", "informationSystem",
                             "externalObject",    "uri",
                             "Address",           "xalAddress",
                             "ImplicitGeometry",  "transformationMatrix",
                             "referencePoint",    "relativeGMLGeometry"};
  static const Names building = {"Building",
                                 "BuildingPart",
                                 "consistsOfBuildingPart",
                                 "class",
                                 "function",
                                 "usage",
                                 "yearOfConstruction",
                                 "roofType",
                                 "measuredHeight",
                                 "storeysAboveGround",
                                 "storeyHeightsAboveGround",
                                 "lod0FootPrint",
                                 "lod1Solid",
                                 "lod2Solid",
                                 "boundedBy",
                                 "lod2MultiSurface",
                                 "lod3Solid",
                                 "lod3MultiSurface",
                                 "lod3Geometry",
                                 "lod3ImplicitRepresentation",
                                 "opening",
                                 "outerBuildingInstallation",
                                 "BuildingInstallation",
                                 "address"};
  static const Names generics = {"stringAttribute", "doubleAttribute", "intAttribute", "measureAttribute", "value"};
  static const Names appearance = {"appearance",        "appearanceMember", "Appearance",    "theme",
                                   "surfaceDataMember", "X3DMaterial",      "isFront",       "ambientIntensity",
                                   "diffuseColor",      "emissiveColor",    "specularColor", "shininess",
                                   "transparency",      "isSmooth",         "target"};
  if (space == kGml) return gml.count(name) > 0;
  if (space == kCore) return core.count(name) > 0;
  if (space == kBuilding) return building.count(name) > 0 || !surface_kind(name).empty() || !opening_kind(name).empty();
  if (space == kGenerics) return generics.count(name) > 0;
  if (space == kAppearance) return appearance.count(name) > 0;
  return space == kAddress;
}

}  // namespace blockrand::validate
