// Builds the facade of one part after the other: what rules order on its walls and on its roof is gathered, then openings are cut
// and told. One class, its functions by subject: facades.cpp derives, facade_orders.cpp takes what rules order,
// facade_passages.cpp opens passages, facade_roof.cpp furnishes the roof, facade_cut.cpp cuts and tells, facade_footprint.cpp
// runs rules that begin on the footprint, facade_masonry.cpp lays stones. Internal to this folder.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/facades/element_library.h"
#include "pipeline/facades/facade_context.h"
#include "pipeline/facades/facade_segments.h"
#include "pipeline/facades/facades.h"
#include "pipeline/facades/footprint_rules.h"
#include "pipeline/facades/grammar_library.h"
#include "pipeline/facades/leaf_polygons.h"
#include "pipeline/facades/masonry_orders.h"
#include "pipeline/facades/openings.h"
#include "pipeline/facades/passages.h"
#include "pipeline/facades/roof_elements.h"
#include "pipeline/facades/rule_geometry.h"
#include "pipeline/facades/wall_masonry.h"
#include "pipeline/facades/wall_paint.h"
#include "pipeline/model/region.h"

namespace blockrand::facades {

/// m that openings of rules keep from the portal of a passage.
inline constexpr double kBesidePortal = 0.1;

/// An element as a rule asked for it, in the coordinates of a wall.
struct Asked {
  std::uint32_t wall = 0, element = 0;
  model::Point2 at;  ///< middle of the lower edge
  std::int32_t storey = 0;
};

class FacadeBuilder {
 public:
  FacadeBuilder(model::Report& report, ElementLibrary& library, const GrammarLibrary& grammars,
                const attributes::Defaults& defaults, const FacadeOptions& options, const model::Extract* extract)
      : report_(report),
        library_(library),
        grammars_(grammars),
        defaults_(defaults),
        options_(options),
        extract_(extract) {}

  /// \param mass  the roof that the part's LoD2 has; gets what is built on it. Null: nothing is
  void build(model::Building& building, model::BuildingPart& part, masses::BuiltMass* mass);

 private:
  /// The body that openings are cut into.
  struct Closed {
    const model::Solid* solid = nullptr;
    const model::SolidTriangles* triangles = nullptr;
  };

  /// Dormers and cross gables on the roof, windows in their fronts and in gables.
  /// \param walls  of the LoD2 solid; becomes those of the furnished one, which begin with them
  void furnish(const GrammarLibrary::Entry& grammar, const model::Building& building, model::BuildingPart& part,
               masses::BuiltMass& mass, std::vector<WallFrame>& walls, const std::vector<FacadeSegment>& segments,
               double eaves, std::uint64_t seed, std::uint64_t row);

  /// What fronts on the roof take over from the windows asked for: those of the topmost storey.
  WindowsBelow windows_below() const;

  static double width_of(const model::Element& element);

  /// Middles of the windows of each wall, on the plan.
  std::vector<WindowAxes> window_axes(const std::vector<WallFrame>& walls, const model::BuildingPart& part) const;

  /// Runs a rule of the rules for roofs.
  grammar::Derivation derive_roof(const FacadeContext& context, const char* rule, const grammar::Shape& shape,
                                  std::string_view place = {});

  /// What rules for roofs get from outside, the same for all derivations of a part.
  void take_roof_parameters(const GrammarLibrary::Entry& grammar, std::uint64_t seed, std::uint64_t row);

  /// Windows of a dormer or cross gable: rules see the front alone, from its lower border.
  void derive_front(const FacadeContext& main, const std::vector<WallFrame>& walls,
                    const std::vector<FacadeSegment>& segments, const RoofFront& front);

  /// Windows in a wall above its eaves.
  void derive_gable(const FacadeContext& main, const std::vector<WallFrame>& walls, const FacadeSegment& segment);

  void derive_piece(const FacadeContext& main, const WallFrame& wall, const FacadeSegment& piece, double foot,
                    const char* rule);

  /// Of windows on the roof those go that do not fit in their front: rules order rows of them, as many as a rectangle takes.
  void keep_within(const std::vector<WallFrame>& walls, std::size_t first);

  /// Rules that begin on the footprint: what they make is the part's LoD3, beside nothing of ours but the elements they order.
  /// \param walls, segments  of the LoD2 solid
  void build_on_footprint(const GrammarLibrary::Entry& grammar, const model::Building& building,
                          model::BuildingPart& part, const std::vector<WallFrame>& walls,
                          const std::vector<FacadeSegment>& segments, double eaves, std::uint64_t seed,
                          std::uint64_t row);
  /// An element on an upright leaf, and what is left of the leaf around its opening.
  /// \return false: the leaf stays what it is
  bool order_on_footprint(const grammar::Leaf& leaf, const grammar::Frame& frame, const LeafPolygons& made,
                          RuleSurfaces& surfaces, model::Detail& detail);

  void derive_segment(const GrammarLibrary::Entry& grammar, const FacadeContext& context, std::uint64_t seed,
                      std::uint64_t row);

  /// Storeys whose looks are ordered and that are not there.
  void tell_unpainted(const model::Building& building, const model::BuildingPart& part);

  /// `blockrand.paint`: how the wall looks where the leaf's shape is.
  void note_paint(const FacadeContext& context, const grammar::Leaf& leaf);

  /// What is ordered of a whole edge.
  void paint_edge(const FacadeContext& context);

  void add_paint(const FacadeContext& context, double left, double right, double low, double high,
                 const std::string& colour, const std::string& material, std::string name);

  /// Layers of paint round the openings. \param opened  by asked_: has an opening
  void apply_paint(model::Detail& detail, const std::vector<WallFrame>& walls, const std::vector<bool>& opened);

  /// What rules make themselves on a wall.
  RuleGeometry geometry_of(const FacadeContext& context, std::span<const grammar::Leaf> leaves);

  void take_geometry(const FacadeContext& context, RuleGeometry made);

  /// The storey that a height in a wall belongs to.
  static std::int32_t storey_at(const FacadeContext& context, double low);

  /// What rules of a preset get from outside, the same for all walls of a building.
  /// Those of district rules are meant for the building's preset.
  void take_parameters(const GrammarLibrary::Entry& grammar, const model::Building& building,
                       const model::BuildingPart& part);

  static grammar::Shape wall_shape(const WallFrame& wall);

  /// Runs along the wall cut into equal pieces, where they are longer than elements can be.
  static std::vector<std::pair<double, double>> no_longer_than(double most,
                                                               std::span<const std::pair<double, double>> runs);

  /// An order of a leaf: an element where its scope is. What would stand in the portal of a passage yields: runs along
  /// the wall are interrupted, the rest is left out.
  void take(const FacadeContext& context, const grammar::Leaf& leaf);

  /// Whether a mapped entrance lies at that piece of the wall.
  static bool at_entrance(const FacadeContext& context, double left, double right);

  /// Takes what the stock was asked for.
  void place(std::uint32_t wall, model::Point2 at, std::int32_t storey);

  /// Cuts all open passages alone; portals of those that cannot be cut are blocked.
  /// \return false where the solid is not valid then
  bool takes_passages(const model::BuildingPart& part, const std::vector<WallFrame>& walls);

  /// Which portals are open.
  std::vector<bool> open_portals() const;

  /// Leaves open what the solid takes: all passages together, else one after another.
  void try_passages(const model::BuildingPart& part, const std::vector<WallFrame>& walls);

  void close_open(PortalState why);

  /// Of all open portals, in their order.
  std::vector<WallOpening> passage_openings() const;

  /// Before all other elements: gates in portals that lead nowhere, a band round those of passages in street fronts.
  void close_portals();

  /// A solid with openings.
  struct Cut {
    OpenedSolid opened;
    model::SolidTriangles triangles;
    std::vector<bool> left_out;         ///< by asked_; empty: none was
    std::vector<std::size_t> of_asked;  ///< by opening given: of which element; kNoAsked for portals of passages
  };

  /// Cuts passages and what elements need; none when the solid is not valid then.
  /// \param left_out  by asked_: gets none
  /// \param bad_face  gets the face that is no sound polygon then, where that is why
  std::optional<Cut> cut_all(const std::vector<WallFrame>& walls, const std::vector<bool>& left_out = {},
                             std::int64_t* bad_face = nullptr) const;

  /// Of a wall that folds with all of its openings, what rules sank stands before it; then every other window goes, then all
  /// openings. The other walls keep theirs.
  std::optional<Cut> cut_most(const std::vector<WallFrame>& walls);

  /// \return  whether the wall has fewer openings now
  bool thin(const std::vector<WallFrame>& walls, std::int64_t face, int step, std::vector<bool>& left_out);

  bool is_sunk_geometry(const Asked& asked) const;
  /// What rules sank into the wall stands before it where the wall takes no opening: it is seen all the same.
  void stand_before(Asked& asked);

  /// Walls, and the reveals of their openings, look as rules say.
  void paint(model::Detail& detail) const;

  /// Where stones are to be laid, if the parameters ask for it. \param segments  with their corners linked
  void note_masonry(const model::BuildingPart& part, const std::vector<WallFrame>& walls,
                    const std::vector<FacadeSegment>& segments, std::uint64_t seed);
  /// Stones round the openings that were cut. \param opened  by asked_: has an opening
  void apply_masonry(model::Detail& detail, const std::vector<WallFrame>& walls, const std::vector<bool>& opened);
  /// Which bond a wall gets, and what it looks like; none: no stones show on such a wall.
  std::optional<std::pair<masonry::Bond, MasonryLook>> masonry_look(std::uint32_t face) const;

  void cut(model::BuildingPart& part, const std::vector<WallFrame>& walls);

  /// Windows that yield to a passage are no failure; doors at mapped entrances are.
  /// \param left_out  of what was asked for
  void finish_told(model::BuildingPart& part, std::size_t left_out);

  /// Each complaint once a part.
  void tell(const std::string& what) { told_.insert(what); }

  static constexpr std::size_t kNoAsked = ~std::size_t{0};
  /// Of cut_most(): a wall is thinned twice at most, and few houses have more than one that folds.
  static constexpr std::size_t kMostTries = 8;
  /// m. Lower gables have no windows.
  static constexpr double kLeastGable = 1.6;
  /// m of wall around windows of dormers and gables.
  static constexpr double kFrontBorder = 0.08;
  /// m; narrower portals get a house door.
  static constexpr double kLeastGate = 1.8;

  model::Report& report_;
  ElementLibrary& library_;
  const GrammarLibrary& grammars_;
  const attributes::Defaults& defaults_;
  const FacadeOptions& options_;
  const model::Extract* extract_;                      ///< of the tags; may be null
  CornerRounding rounding_ = CornerRounding::nearest;  ///< of the part at work
  grammar::DeriveOptions derive_options_;
  grammar::AttributeMemo memo_;                         ///< of the part at work
  const GrammarLibrary::Entry* derived_for_ = nullptr;  ///< whose values derive_options_ holds, with these parameters
  decltype(model::Building::preset_parameters) parameters_;
  std::vector<std::uint32_t> outside_;
  std::vector<Asked> asked_;
  std::vector<PassagePortal> portals_;
  /// The open portals with which, and no other opening, the solid is valid and its borders stayed as they are; empty: not known.
  std::vector<bool> checked_portals_;
  std::size_t portal_elements_ = 0;    ///< the first of asked_: what close_portals() put there
  std::size_t yielding_ = 0;           ///< elements that would stand in a portal
  std::size_t yielding_geometry_ = 0;  ///< leaves that stand in a portal as a whole
  std::size_t before_wall_ = 0;        ///< sunk bodies of rules that got no opening
  std::size_t missed_doors_ = 0;       ///< those of them that are doors at mapped entrances
  std::set<std::string> told_;
  std::vector<PaintOrder> paint_orders_;         ///< of the part at work
  std::optional<MasonryOrders> masonry_orders_;  ///< of the part at work
  std::vector<MasonryRun> masonry_runs_;
  std::map<std::uint32_t, model::PartMaterial> painted_;  ///< by face: walls that rules gave another look
  std::map<std::string, std::size_t> dropped_;            ///< leaves by "Symbol: why"
  PartMaterials usual_materials_;                         ///< of the part at work
  std::vector<std::string> complaints_;
  std::vector<std::pair<double, double>> pieces_;
  const grammar::Deriver* roof_rules_ = nullptr;
  grammar::DeriveOptions roof_options_;
  grammar::AttributeMemo roof_memo_;  ///< of the part at work
  std::vector<std::uint32_t> roof_outside_;
  Closed closed_;                           ///< of the part at work
  std::optional<FurnishedRoof> furnished_;  ///< the same, with dormers and cross gables; none: it has none
};

}  // namespace blockrand::facades
