// The OSM keys that the program reads by name, in one table: code says osm_key::kHighway, docs/osm_keys.md is made of
// it. Rules in configs/ name further keys, as users may: they stand in the rules alone.
#pragma once

#include <string_view>

namespace blockrand::model {

/// X(constant, key, what its value is used for). Who adds a key reads it somewhere and makes the page anew:
/// OSM_KEYS_PAGE=1 tests/test_osm_keys. Objects that are kept for a key: importers/osm/interest_rules.h.
// clang-format off
#define BLOCKRAND_OSM_KEYS(X)                                                                                     \
  X(kBuilding, "building", "a building; the value is its use")                                                    \
  X(kBuildingPart, "building:part", "a part of a building; the value is its use")                                 \
  X(kBuildingUse, "building:use", "use of the building, told beside the class of its form")                       \
  X(kBuildingArchitecture, "building:architecture", "architectural style: stands for a year of construction")     \
  X(kType, "type", "what a relation is: multipolygon, building, boundary")                                        \
  X(kLocation, "location", "underground, underwater: not built")                                                  \
  X(kLayer, "layer", "below 0: underground unless it is a roof or a bridge; which of two crossing ways is above") \
  X(kTunnel, "tunnel", "building_passage: a way through a building; other values: below ground")                  \
  X(kCovered, "covered", "a way below a building")                                                                \
  X(kHeight, "height", "top of the roof above ground, m")                                                         \
  X(kBuildingHeight, "building:height", "the same, older")                                                        \
  X(kEstHeight, "est_height", "the same, estimated")                                                              \
  X(kMinHeight, "min_height", "underside above ground, m")                                                        \
  X(kBuildingMinHeight, "building:min_height", "the same, older")                                                 \
  X(kBuildingLevels, "building:levels", "full storeys above ground")                                              \
  X(kLevels, "levels", "the same, older")                                                                         \
  X(kBuildingMinLevel, "building:min_level", "storeys left out below")                                            \
  X(kMinLevel, "min_level", "the same, older")                                                                    \
  X(kBuildingLevelsUnderground, "building:levels:underground", "storeys below ground: read and checked, not built")\
  X(kRoofLevels, "roof:levels", "storeys in the roof")                                                            \
  X(kBuildingRoofLevels, "building:roof:levels", "the same, older")                                               \
  X(kRoofShape, "roof:shape", "shape of the roof")                                                                \
  X(kBuildingRoofShape, "building:roof:shape", "the same, older")                                                 \
  X(kBuildingRoof, "building:roof", "shape of the roof where the value is one")                                   \
  X(kRoofHeight, "roof:height", "eaves to the top of the roof, m")                                                \
  X(kBuildingRoofHeight, "building:roof:height", "the same, older")                                               \
  X(kRoofAngle, "roof:angle", "pitch, degrees")                                                                   \
  X(kBuildingRoofAngle, "building:roof:angle", "the same, older")                                                 \
  X(kPreset, "blockrand:preset", "preset of the fronts; on an area: of all houses in it")                         \
  X(kStyle, "blockrand:style", "class of appearance or sub-style; on an area: of all houses in it")               \
  X(kRoofPitches, "blockrand:roof_pitches", "pitches of single sides of the roof, degrees: street 60, yard 30")   \
  X(kRoofDirection, "roof:direction", "where the main slope falls to")                                            \
  X(kRoofSlopeDirection, "roof:slope:direction", "the same, older")                                               \
  X(kRoofOrientation, "roof:orientation", "ridge along or across the longer side")                                \
  X(kBuildingRoofOrientation, "building:roof:orientation", "the same, older")                                     \
  X(kRoofRidge, "roof:ridge", "a line: a ridge of the roof it lies on")                                           \
  X(kRoofEdge, "roof:edge", "a line: an edge of the roof it lies on")                                             \
  X(kRoofApex, "roof:apex", "a point: a top of the roof it lies on")                                              \
  X(kBuildingColour, "building:colour", "colour of the walls")                                                    \
  X(kBuildingColor, "building:color", "the same, as often misspelt")                                              \
  X(kBuildingFacadeColour, "building:facade:colour", "the same, older")                                           \
  X(kFacadeColour, "facade:colour", "the same, older")                                                            \
  X(kRoofColour, "roof:colour", "colour of the roof")                                                             \
  X(kRoofColor, "roof:color", "the same, as often misspelt")                                                      \
  X(kBuildingRoofColour, "building:roof:colour", "the same, older")                                               \
  X(kBuildingMaterial, "building:material", "material of the walls")                                              \
  X(kBuildingFacadeMaterial, "building:facade:material", "the same, older")                                       \
  X(kFacadeMaterial, "facade:material", "the same, older")                                                        \
  X(kRoofMaterial, "roof:material", "material of the roof")                                                       \
  X(kBuildingRoofMaterial, "building:roof:material", "the same, older")                                           \
  X(kStartDate, "start_date", "when it was built; half believed of an object that is a business too")             \
  X(kBuildingStartDate, "building:start_date", "when it was built")                                               \
  X(kBuildingYearOfConstruction, "building:year_of_construction", "the same")                                     \
  X(kYearOfConstruction, "year_of_construction", "the same")                                                      \
  X(kConstructionDate, "construction_date", "the same")                                                           \
  X(kName, "name", "name of a building, a street, a place")                                                       \
  X(kAddrCountry, "addr:country", "address")                                                                      \
  X(kAddrCity, "addr:city", "address")                                                                            \
  X(kAddrSuburb, "addr:suburb", "address")                                                                        \
  X(kAddrPostcode, "addr:postcode", "address")                                                                    \
  X(kAddrStreet, "addr:street", "address; the street that a house belongs to")                                    \
  X(kAddrPlace, "addr:place", "address where there is no street")                                                 \
  X(kAddrHousenumber, "addr:housenumber", "address; a house that has one is no outbuilding")                      \
  X(kAddrHousename, "addr:housename", "address")                                                                  \
  X(kAddrInterpolation, "addr:interpolation", "a line of addresses: no area")                                     \
  X(kShop, "shop", "a shop; use of the ground floor")                                                             \
  X(kAmenity, "amenity", "an amenity; use of the ground floor")                                                   \
  X(kOffice, "office", "a business: its date may not be the building's")                                          \
  X(kCraft, "craft", "the same")                                                                                  \
  X(kTourism, "tourism", "hotel, museum: the same")                                                               \
  X(kHeritage, "heritage", "a listed house")                                                                      \
  X(kHistoric, "historic", "the same")                                                                            \
  X(kEntrance, "entrance", "an entrance")                                                                         \
  X(kDoor, "door", "an entrance")                                                                                 \
  X(kHighway, "highway", "a street and its class")                                                                \
  X(kRailway, "railway", "a railway and its kind")                                                                \
  X(kService, "service", "of a railway: a siding, which bounds no block")                                         \
  X(kWaterway, "waterway", "water")                                                                               \
  X(kWater, "water", "river, canal, stream: not level")                                                           \
  X(kNatural, "natural", "trees, water, coastline, land use")                                                     \
  X(kLanduse, "landuse", "land use; quarters of rules")                                                           \
  X(kLeisure, "leisure", "land use")                                                                              \
  X(kBarrier, "barrier", "walls, fences, hedges")                                                                 \
  X(kPlace, "place", "places that rules name")                                                                    \
  X(kBoundary, "boundary", "boundaries that rules name")                                                          \
  X(kArea, "area", "whether a closed way is an area")                                                             \
  X(kBridge, "bridge", "a way above others")                                                                      \
  X(kJunction, "junction", "roundabout: one way")                                                                 \
  X(kOneway, "oneway", "direction of a street")                                                                   \
  X(kIndoor, "indoor", "a way inside a building: no street")                                                      \
  X(kWidth, "width", "width of a passage, a street, a water, m")                                                  \
  X(kLanes, "lanes", "of a street: its width")                                                                    \
  X(kSurface, "surface", "what a street or place is paved with")                                                  \
  X(kTracktype, "tracktype", "the same of tracks")                                                                \
  X(kSidewalk, "sidewalk", "pavements beside a street")                                                           \
  X(kSidewalkBoth, "sidewalk:both", "the same")                                                                   \
  X(kSidewalkLeft, "sidewalk:left", "the same")                                                                   \
  X(kSidewalkRight, "sidewalk:right", "the same")                                                                 \
  X(kCycleway, "cycleway", "tracks for bicycles beside a street")                                                 \
  X(kCyclewayBoth, "cycleway:both", "the same")                                                                   \
  X(kCyclewayLeft, "cycleway:left", "the same")                                                                   \
  X(kCyclewayRight, "cycleway:right", "the same")                                                                 \
  X(kParkingLane, "parking:lane:", "parking lanes, the older scheme: both, left, right")                          \
  X(kParkingBoth, "parking:both", "parking beside a street")                                                      \
  X(kParkingLeft, "parking:left", "the same")                                                                     \
  X(kParkingRight, "parking:right", "the same")                                                                   \
  X(kFootway, "footway", "sidewalk, crossing: what a footway is")                                                 \
  X(kCrossing, "crossing", "how a crossing is marked")                                                            \
  X(kCrossingMarkings, "crossing:markings", "the same")                                                           \
  X(kAreaHighway, "area:highway", "ground of a street as an area")                                                \
  X(kManMade, "man_made", "bridges, piers, masts, towers")                                                        \
  X(kPower, "power", "power lines, poles, towers, generators")                                                    \
  X(kGeneratorSource, "generator:source", "wind: a wind turbine")                                                 \
  X(kAeroway, "aeroway", "runways, taxiways, aprons")                                                             \
  X(kAerialway, "aerialway", "cable ways and their pylons: wires")                                                \
  X(kAdvertising, "advertising", "advertising columns and boards")                                                \
  X(kEmergency, "emergency", "hydrants")                                                                          \
  X(kTrafficSign, "traffic_sign", "a sign")                                                                       \
  X(kTrafficSignalsDirection, "traffic_signals:direction", "which direction stops")                               \
  X(kStepCount, "step_count", "how many treads steps have")                                                       \
  X(kIncline, "incline", "where steps rise")                                                                      \
  X(kPublicTransport, "public_transport", "platforms and stops")                                                  \
  X(kPlayground, "playground", "play equipment")                                                                  \
  X(kGolf, "golf", "greens, tees, bunkers, fairways")                                                             \
  X(kLeafType, "leaf_type", "needleleaved, broadleaved")                                                          \
  X(kLeafCycle, "leaf_cycle", "evergreen, deciduous")                                                             \
  X(kGenus, "genus", "of a tree: conifer or not")                                                                 \
  X(kSpecies, "species", "the same")                                                                              \
  X(kTaxon, "taxon", "the same")                                                                                  \
  X(kDiameterCrown, "diameter_crown", "of a tree, m")                                                             \
  X(kCircumference, "circumference", "of a trunk, m: the height of a tree where nobody tells it")                 \
  X(kMaterial, "material", "of a wall, a fence, a bench")                                                         \
  X(kFenceType, "fence_type", "what a fence looks like")                                                          \
  X(kDirection, "direction", "where a bench, a sign faces")                                                       \
  X(kDrivingSide, "driving_side", "on which side of a street vehicles keep")                                      \
  X(kGauge, "gauge", "of a railway, mm")
// clang-format on

namespace osm_key {
#define X(constant, key, use) inline constexpr std::string_view constant = key;
BLOCKRAND_OSM_KEYS(X)
#undef X
}  // namespace osm_key

struct OsmKeyInfo {
  std::string_view constant, key, use;
};
inline constexpr OsmKeyInfo kOsmKeys[] = {
#define X(constant, key, use) {#constant, key, use},
    BLOCKRAND_OSM_KEYS(X)
#undef X
};

}  // namespace blockrand::model
