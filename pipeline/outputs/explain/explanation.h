// Why each building looks as it does: what `blockrand explain` reads.
//
// A tile's explanations are lines of JSON, one per building, in the order of the region:
//
//   {"id":"w1","tile":"15_1_2","state":"modelled","lod":2,        what became of it; "code" and "meaning" when reported
//    "place":{"lon":12.37,"lat":51.34},"name":…,"address":…,      middle of the mapped outline
//    "tags":{…},                                                  all OSM tags
//    "outline":{"nodes":[…],"lon":[…],"lat":[…],"rings":[…]},     as mapped: node ids, 1e-7 degrees; points per ring
//    "stages":[{"stage":"read","text":…},…],                      what each stage did, in the order of the flow
//    "imagery":{"state":"moved","shift_east":1.2,…},              where an aerial image shows it: imagery_attributes()
//    "repair":{"vertices":14,"moved":12,"mean_shift":0.08,"max_shift":0.31,"mapped_area":312.4,"area":313,"shared_walls":3,
//              "gaps_closed":1,"overlaps_resolved":0,"overlap_left":0,"direction":27.3},      where repair left a record
//    "situation":{"position":"mid_row","orientation":180,"depth":14,"width":18,"setback":0.4,"party_wall_length":28,
//                 "block":…,"courtyards":[…],"trees":[{"id":"n5","distance":3.1}]},            where context looked
//    "edges":[{"id":"w1.e11_12","kind":"street","confidence":0.9,"length":18,"looks":"S","front":true,"neighbour":…,
//              "street":…,"street_name":…,"street_distance":…,"visibility":…,"radius":…},…],    where context looked
//    "style":{"class":"gruenderzeit","probabilities":{"gruenderzeit":0.82,…},"era":{"pre1840":0.01,…},"years":[1890,1895],
//             "morphology":{"perimeter_block":0.9,…},"substyle":"gz_mk_front","substyle_p":0.64,"rule":…,
//             "prior":{"gruenderzeit":-0.2,…},"elsewhere":{…},"second":"modern",
//             "terms":[{"feature":"depth_ratio","meaning":…,"value":1.9,"unit":…,"low":1.5,"high":2.2,"weights":{…}},…],
//             "changes":[…]},       where it was classified: model/style.h; weights are log-odds, open bins have no low, high
//    "attributes":[{"name":"storeys","value":5,"unit":"","source":"neighbours","confidence":0.6,"why":…,
//                   "lost":[{"value":"4","source":"preset","confidence":0.3,"why":…}]},…],
//    "bodies":[{"id":"w1","lod":2,"asked_roof":"gabled","built_roof":"hipped","fallbacks":["ROOF_SHAPE_ADAPTED"],
//               "detail":{"windows":24,"doors":1,"passages":1,"elements":{"casement":24,…},"roof_elements":{"dormer":2,…},"installations":{"chimney":3,…}},
//               …}],                  detail: of LoD3
//    "notes":[{"code":"SPIKE_REMOVED","class":"notice","meaning":…,"detail":"1 points"}],
//    "files":["tiles/15/1/2.glb",…]}
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/model/region.h"
#include "pipeline/outputs/imagery/seen_outline.h"
#include "pipeline/outputs/sink.h"

namespace blockrand::outputs {

/// What became of an object of the extract.
struct FinalState {
  model::ObjectState state = model::ObjectState::pending;
  model::IssueCode code = model::IssueCode::none;
  model::OsmId related;
};

/// What context knows of a courtyard.
struct CourtyardFacts {
  double area = 0;  ///< m²
  bool closed = true;
};
/// By the id of the courtyard.
using CourtyardLookup = std::function<std::optional<CourtyardFacts>(std::string_view)>;

struct ExplainOptions {
  std::string tile;                ///< "15_17600_12900"
  std::vector<std::string> files;  ///< of the tile, relative to the build
  int lod = 2;                     ///< asked for
  /// What becomes of object `mapped_index` of the extract.
  std::function<FinalState(std::uint32_t)> final_state;
  /// Rows about the tile's objects from before the tile was worked on, sorted by object.
  std::span<const model::ReportRow> earlier;
  /// Of BuildingSituation::courtyards; may be empty.
  CourtyardLookup courtyard;
  /// What aerial images show; may be empty.
  SeenOutlines seen;
  /// The rule file of a preset; empty for one without, or where facades were not asked for. May be empty.
  std::function<std::string(std::string_view preset)> rule_file;
};

struct Explanations {
  std::string lines;
  /// Every object that a line speaks of, building or part, with the building whose line it is.
  std::vector<std::pair<model::OsmId, model::OsmId>> objects;
  /// Each building with its line of explain/places.tsv (places.h).
  std::vector<std::pair<model::OsmId, std::string>> places;
};

/// Explains the owned buildings of a region after its masses were built; also those that ended as reported.
/// The same region gives the same bytes.
/// \param take  gets the lines in pieces of about kExplainedPiece, the last one shorter, and leaves Explanations::lines empty; null:
///              all lines are there
Explanations explain(const model::Region& region, const ExplainOptions& options, const Sink& take = nullptr);
/// Bytes. A tile of two thousand buildings has forty million.
inline constexpr std::size_t kExplainedPiece = 2'000'000;

/// "w123 15_1_2 w123": object, tile, building whose line explains it.
std::string index_line(model::OsmId object, std::string_view tile, model::OsmId building);

}  // namespace blockrand::outputs
