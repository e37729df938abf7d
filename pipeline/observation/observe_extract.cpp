#include "pipeline/observation/observe_extract.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "pipeline/base/parallel.h"
#include "pipeline/base/portable_math.h"
#include "pipeline/footprints/move_buildings.h"
#include "pipeline/footprints/terrace_rows.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/observation/eaves.h"
#include "pipeline/observation/edge_refinement.h"
#include "pipeline/observation/image_fit.h"
#include "pipeline/observation/image_quality.h"
#include "pipeline/observation/lean.h"
#include "pipeline/observation/mixed_bits.h"
#include "pipeline/observation/presence.h"
#include "pipeline/observation/roof_view.h"
#include "pipeline/observation/row_match.h"
#include "pipeline/observation/rows_off_alike.h"
#include "pipeline/observation/shadow_heights.h"
#include "pipeline/observation/unmapped.h"
#include "pipeline/observation/verdict.h"

namespace blockrand::observation {

namespace {

using model::Point2;

/// m: pixels in which rows are searched, and in which an image's place is checked.
constexpr double kPixel = 0.2, kCoarsePixel = 0.5;
/// m: buildings nearer than this move as one, as repair has it.
constexpr double kRowLink = 1.0;
/// Outlines that an image is fitted with first; where they leave a doubt (a margin under kClearMargin), at most.
constexpr std::size_t kFirstFitSample = 150;
constexpr double kClearMargin = 5;
constexpr std::size_t kFitSample = 400;
/// Of a metre of wall that two buildings share: often no edge shows there.
constexpr double kPartyWallWeight = 0.15;
/// Levels of 255, as score_outline() has it.
constexpr double kContrast = 12;

/// m: of a building's box; larger ones are not looked for.
constexpr double kLargestBuilding = 400;

/// m: displacements at which outlines are sighted before the lean is known, and their step.
constexpr double kSightingReach = 8, kSightingStep = 0.5;

/// Of a row's walls: where the lean of as many is known, they decide.
constexpr double kMostlyKnown = 0.75;
/// How often shadows and lean are measured anew, each with what the other told.
constexpr int kShadowRounds = 1;
/// Shadows that storeys are counted by: how clear they are (ShadowLength::clearness), m of wall that cast them; and the share
/// of those that tell the eaves to a quarter (docs/internal/RESULTS.md, "Aerial images").
constexpr double kSureShadow = 0.2, kSureWalls = 10, kShadowConfidence = 0.8;

double rounded(double value, double steps) { return std::round(value * steps) / steps + 0.0; }
Point2 rounded(Point2 p) { return {rounded(p.x, 1000), rounded(p.y, 1000)}; }

class Observer {
 public:
  Observer(const ObservedExtract& of, std::span<const importers::imagery::AerialImage> images, int workers,
           Correction correct, double refine_within, base::Progress& progress)
      : of_(of),
        images_(images),
        correct_(correct),
        refine_within_(refine_within),
        workers_(workers),
        progress_(progress) {}

  ImageryObservations run() {
    ImageryObservations out;
    const footprints::FootprintStore& store = of_.footprints;
    out.outlines.resize(store.size());
    out.roofs.resize(store.size());
    out.heights.resize(store.size());
    index_ = footprints::index_of(store);
    rows_ = footprints::find_terrace_rows(store, kRowLink);
    row_of_.assign(store.size(), 0);
    spoken_.assign(rows_.size(), std::nullopt);
    for (std::uint32_t r = 0; r < rows_.size(); ++r)
      for (const std::uint32_t b : rows_[r].buildings) row_of_[b] = r;
    eaves_ = EavesHeights(of_.extract, store);
    progress_.begin("match outlines", rows_.size() * images_.size(), "rows");
    for (std::uint32_t k = 0; k < images_.size(); ++k) {
      const ImageWindows coarse(images_[k], of_.projection, kCoarsePixel);
      out.images.push_back(fitted(k, coarse));
      ImageReceipt& image = out.images.back();
      if (image.fit.state != ImageState::misfit) {
        field_ = {};
        const bool judges = image.fit.state == ImageState::used && correct_ != Correction::off;
        eaves_.forget_shadows();
        if (judges) sight(k, coarse, out);
        image.leans = field_.leans(), image.flight_height = field_.flight_height(), image.support = field_.support(),
        image.shift = rounded(field_.shift());
        match_rows(k, judges, out);
      }
      progress_.advance_to((k + 1) * rows_.size());
    }
    // When all images have spoken: what one says of a row may be what another one decides.
    for (std::uint32_t k = 0; k < images_.size(); ++k) doubt_rows_off_alike(k, out);
    flag_gone(out);
    out.unmapped = without_overlaps(std::move(out.unmapped));
    const auto unsure = std::ranges::find_if(out.unmapped, [](const auto& u) { return u.probability < kTellUnmapped; });
    out.unmapped_unsure.assign(unsure, out.unmapped.end());
    out.unmapped.erase(unsure, out.unmapped.end());
    for (std::uint32_t b = 0; b < out.outlines.size(); ++b) {
      const std::uint32_t by_outline = out.outlines[b].image, by_roof = out.roofs[b].image;
      if (by_outline < out.images.size()) ++out.images[by_outline].buildings;
      if (out.roofs[b].pixels > 0 && by_roof != by_outline) ++out.images[by_roof].buildings;
    }
    return out;
  }

 private:
  /// Buildings that perhaps do not stand any more; what stands nowhere is not moved either.
  void flag_gone(ImageryObservations& out) const {
    for (std::uint32_t b = 0; b < out.outlines.size(); ++b) {
      OutlineReceipt& receipt = out.outlines[b];
      const SeenHeight& seen = out.heights[b];
      const double gone =
          gone_probability(receipt, out.roofs[b], seen.image == receipt.image ? seen.shadow.clearness : 0);
      if (gone < kPerhapsGone) continue;
      receipt.gone = rounded(gone, 100);
      if (receipt.state == RowState::corrected && rows_[receipt.row].buildings.size() == 1)
        restate(receipt, RowState::undecided, "perhaps it does not stand any more");
      receipt.refined = {};
    }
  }

  SearchedOutline searched(std::uint32_t building, const std::map<std::pair<Point2, Point2>, int>* shared) const {
    SearchedOutline outline;
    outline.box = of_.footprints[building].box;
    std::vector<double> weights;
    of_.footprints.for_each_ring(building, [&](std::span<const Point2> ring, bool) {
      weights.assign(ring.size(), 1.0);
      for (std::size_t i = 0; shared && i < ring.size(); ++i) {
        const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
        if (shared->contains({std::min(a, b), std::max(a, b)}) && shared->at({std::min(a, b), std::max(a, b)}) > 1)
          weights[i] = kPartyWallWeight;
      }
      add_pieces(ring, weights, outline.pieces);
    });
    return outline;
  }

  /// Larger ones than any house would need windows of the whole image.
  bool searchable(std::uint32_t b) const {
    const geometry::PlanBox& box = of_.footprints[b].box;
    return !box.empty() && of_.footprints[b].settled == model::ObjectState::pending &&
           box.maximum.x - box.minimum.x <= kLargestBuilding && box.maximum.y - box.minimum.y <= kLargestBuilding;
  }

  /// How many buildings in an image were edited after the last day that its date can mean; 0: it has no date.
  std::uint64_t edited_later(const importers::imagery::AerialImage& image) const {
    const std::optional<std::uint32_t> taken = last_second(image.describe().source.date);
    std::uint64_t count = 0;
    for (std::uint32_t b = 0; taken && b < of_.footprints.size(); ++b)
      count += searchable(b) && of_.extract.buildings[of_.footprints[b].lead].edited > *taken &&
               within(image, of_.footprints[b].box.centre());
    return count;
  }

  /// Outlines within an image, spread over it, in an order that hangs on their ids alone.
  std::vector<SearchedOutline> sample(const importers::imagery::AerialImage& image, std::size_t most) const {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> chosen;
    for (std::uint32_t b = 0; b < of_.footprints.size(); ++b) {
      if (!searchable(b)) continue;
      if (!within(image, of_.footprints[b].box.centre())) continue;
      chosen.emplace_back(mixed(static_cast<std::uint64_t>(of_.footprints[b].id.number)), b);
    }
    std::sort(chosen.begin(), chosen.end());
    if (chosen.size() > most) chosen.resize(most);
    std::vector<SearchedOutline> out;
    for (const auto& [key, b] : chosen) out.push_back(searched(b, nullptr));
    return out;
  }

  SearchedRow searched_row(const footprints::TerraceRowPlan& plan) const {
    SearchedRow row;
    std::map<std::pair<Point2, Point2>, int> edges;
    for (const std::uint32_t b : plan.buildings)
      if (searchable(b))
        of_.footprints.for_each_ring(b, [&](std::span<const Point2> ring, bool) {
          for (std::size_t i = 0; i < ring.size(); ++i) {
            const Point2 a = ring[i], c = ring[(i + 1) % ring.size()];
            ++edges[{std::min(a, c), std::max(a, c)}];
          }
        });
    double x = 0, y = 0, length = 0;
    for (const std::uint32_t b : plan.buildings) {
      if (!searchable(b)) continue;
      row.outlines.push_back(searched(b, &edges));
      SearchedOutline& o = row.outlines.back();
      o.height = eaves_.height(b);
      const std::optional<Point2> lean = field_.at(o.box.centre(), o.height);
      o.lean_known = lean.has_value() && (field_.found() || eaves_.surely_low(b));
      o.lean = lean.value_or(Point2{});
      if (field_.leans()) {
        o.per_metre = field_.per_metre(o.box.centre()).value_or(Point2{});
        o.ground = field_.shift();
        o.uncertainty = eaves_.uncertainty(b);
      }
      for (const WallPiece& p : row.outlines.back().pieces)
        x += p.middle.x * p.length, y += p.middle.y * p.length, length += p.length;
    }
    if (length > 0) row.centre = {x / length, y / length};
    for (const SearchedOutline& o : row.outlines)
      for (const WallPiece& p : o.pieces)
        row.radius = std::max(row.radius, std::sqrt((p.middle.x - row.centre.x) * (p.middle.x - row.centre.x) +
                                                    (p.middle.y - row.centre.y) * (p.middle.y - row.centre.y)));
    leave_out_unknown(row);
    return row;
  }

  /// Houses that stand where nobody knows the lean say nothing of their row's place, if it is known of most of its walls.
  static void leave_out_unknown(SearchedRow& row) {
    double known = 0, all = 0;
    for (const SearchedOutline& o : row.outlines)
      for (const WallPiece& p : o.pieces) known += o.lean_known ? p.length : 0, all += p.length;
    if (known < kMostlyKnown * all) return;
    for (SearchedOutline& o : row.outlines)
      if (!o.lean_known) o.pieces.clear(), o.lean_known = true;
  }

  bool within(const importers::imagery::AerialImage& image, Point2 p) const {
    const georef::GeoBox& area = image.describe().area;
    const georef::LonLat place = of_.projection.inverse(p);
    return place.lon >= area.west && place.lon <= area.east && place.lat >= area.south && place.lat <= area.north;
  }

  /// Some of a box may lie in the image.
  bool near(const importers::imagery::AerialImage& image, const geometry::PlanBox& box) const {
    return within(image, box.centre()) || within(image, box.minimum) || within(image, box.maximum) ||
           within(image, {box.minimum.x, box.maximum.y}) || within(image, {box.maximum.x, box.minimum.y});
  }

  /// Whether an image fits the map, and how good it is.
  ImageReceipt fitted(std::uint32_t k, const ImageWindows& coarse) const {
    ImageReceipt out;
    out.description = images_[k].describe();
    out.fit = fit_image(sample(images_[k], kFirstFitSample), coarse, workers_);
    if (out.fit.state != ImageState::used || out.fit.margin < kClearMargin)
      out.fit = fit_image(sample(images_[k], kFitSample), coarse, workers_);
    const ImageQuality quality = measure_quality(sample(images_[k], kFirstFitSample), coarse);
    if (quality.houses >= kFewestForQuality)
      out.haze = rounded(quality.haze, 100), out.clouded = rounded(quality.clouded, 1000);
    out.edited_later = edited_later(images_[k]);
    return out;
  }

  /// Where the image shows each outline, before anything is known of its lean.
  void sight(std::uint32_t image, const ImageWindows& windows, ImageryObservations& out) {
    std::vector<SightedOutline> sighted(of_.footprints.size());
    const Displacements grid{kSightingStep, static_cast<int>(std::lround(kSightingReach / kSightingStep))};
    base::ordered_parallel(
        sighted.size(), workers_, static_cast<std::size_t>(workers_) * 16,
        [&](std::size_t n) {
          const auto b = static_cast<std::uint32_t>(n);
          if (!searchable(b)) return;
          const SearchedOutline o = searched(b, nullptr);
          if (!within(images_[image], o.box.centre())) return;
          sighted[n].place = o.box.centre();
          sighted[n].height = eaves_.height(b);
          sighted[n].guessed = !eaves_.is_tagged(b);
          sighted[n].row = row_of_[b];
          sighted[n].weight = 1 / std::sqrt(static_cast<double>(rows_[row_of_[b]].buildings.size()));
          const ScoreMap map = score_outline(o.pieces, windows.window(o.box, score_margin(grid, windows.size())), grid,
                                             o.box.centre(), {}, kContrast);
          if (map.weight > 0 && map.missing <= 0.2 * (map.weight + map.missing))
            sighted[n].sightings = sightings_of(map);
        },
        [](std::size_t) {});
    field_ = LeanField(sighted, workers_);
    const ShadowInputs inputs{.sighted = sighted,
                              .heights = eaves_.unseen_heights(),
                              .uncertainty = eaves_.unseen_uncertainty(),
                              .footprints = of_.footprints,
                              .index = index_,
                              .outline = [this](std::uint32_t b) { return searched(b, nullptr); },
                              .windows = windows,
                              .workers = workers_};
    ShadowHeights shadows = measure_shadows(inputs, field_, {});
    for (int round = 0;; ++round) {
      take_heights(shadows, sighted);
      field_ = LeanField(sighted, workers_);
      if (round == kShadowRounds) break;
      shadows = measure_shadows(inputs, field_, shadows.sun);
    }
    tell_shadows(image, shadows, out);
    std::ranges::move(find_unmapped({.extract = of_.extract,
                                     .footprints = of_.footprints,
                                     .index = index_,
                                     .projection = of_.projection,
                                     .windows = windows,
                                     .field = field_,
                                     .eaves = eaves_.heights(),
                                     .in_image =
                                         [&](std::uint32_t b) {
                                           return searchable(b) &&
                                                  within(images_[image], of_.footprints[b].box.centre());
                                         },
                                     .to_sun = shadows.sun.towards,
                                     .image = image,
                                     .workers = workers_}),
                      std::back_inserter(out.unmapped));
  }

  void take_heights(const ShadowHeights& shadows, std::vector<SightedOutline>& sighted) {
    eaves_.take(shadows);
    for (std::uint32_t b = 0; b < sighted.size(); ++b) {
      sighted[b].height = eaves_.height(b);
      sighted[b].guessed = eaves_.uncertainty(b) > kTaggedUncertainty;
    }
  }

  static void tell_shadows(std::uint32_t image, const ShadowHeights& shadows, ImageryObservations& out) {
    ImageReceipt& receipt = out.images[image];
    if (shadows.sun.towards) {
      const double azimuth = 90 - base::atan2(shadows.sun.towards->y, shadows.sun.towards->x) * base::kDegreesPerRadian;
      receipt.shadow_azimuth = azimuth < 0 ? azimuth + 360 : azimuth;
    }
    receipt.shadow_per_metre = shadows.sun.per_metre, receipt.shadow_houses = shadows.sun.houses;
    receipt.shadow_by_tags = shadows.sun.tagged;
    for (std::uint32_t b = 0; b < shadows.buildings.size(); ++b) {
      const ShadowHeight& seen = shadows.buildings[b];
      if (seen.height <= 0) continue;
      SeenHeight& before = out.heights[b];
      if (before.image != SeenHeight::kNoImage && before.shadow.clearness >= seen.shadow.clearness) continue;
      const double own = shadow_uncertainty(seen.shadow.clearness),
                   share = std::sqrt(own * own + shadows.sun.uncertainty * shadows.sun.uncertainty);
      before = {image, seen.shadow, rounded(seen.height, 10), rounded(seen.height * share, 10)};
      before.shadow.length = rounded(seen.shadow.length, 100);
      const bool sure = shadows.sun.tagged && seen.shadow.clearness >= kSureShadow && seen.shadow.walls >= kSureWalls;
      before.confidence = sure ? kShadowConfidence : 0;
    }
  }

  /// \param judges  the image is known to lie right: else its roofs are looked at, and no outline is judged by it
  void match_rows(std::uint32_t image, bool judges, ImageryObservations& out) {
    const ImageWindows windows(images_[image], of_.projection, kPixel);
    /// What is known of a row when it was looked at.
    struct Looked {
      RowMatch match;
      Verdict verdict;
      Point2 centre;
      std::vector<RoofView> roofs;          ///< by outline
      std::vector<RefinedOutline> refined;  ///< by outline
    };
    std::vector<Looked> looked(rows_.size());
    base::ordered_parallel(
        rows_.size(), workers_, static_cast<std::size_t>(workers_) * 8,
        [&](std::size_t r) {
          const SearchedRow row = searched_row(rows_[r]);
          looked[r].centre = row.centre;
          if (std::ranges::none_of(row.outlines, [&](const SearchedOutline& o) { return near(images_[image], o.box); }))
            return;
          looked[r].verdict = {RowState::undecided, "too little of its row lies in the image", 0};
          if (judges) {
            looked[r].match = match_row(row, windows, {}, kContrast);
            const bool known = std::ranges::all_of(row.outlines, &SearchedOutline::lean_known);
            if (looked[r].match.seen)
              looked[r].verdict = judge(looked[r].match, known, explained_by_height(row, looked[r].match));
          } else {
            looked[r].verdict.reason = correct_ == Correction::off ? "outlines were not to be looked for"
                                                                   : "whether the image fits the map is not known";
          }
          look_at_roofs(rows_[r], row, windows, looked[r].match, looked[r].verdict, looked[r].roofs);
          looked[r].refined = refine_row(rows_[r], row, windows, looked[r].match, looked[r].verdict);
        },
        [&](std::size_t r) {
          progress_.advance_to(image * rows_.size() + r + 1);
          Looked row = std::move(looked[r]);
          looked[r] = {};
          if (row.roofs.empty()) return;
          // A row moves as one: where images overlap, the one that is surest of it speaks for all its houses, and the others
          // for or against it.
          const bool judged = row.match.seen;
          bool surest = judged;
          Verdict verdict = row.verdict;
          if (judged && spoken_[r]) {
            std::tie(surest, verdict) = joined(*spoken_[r], seen_place(image, row.verdict, row.match, row.centre));
            if (!surest) revise(rows_[r], verdict, out);
          }
          if (judged && surest) spoken_[r] = seen_place(image, verdict, row.match, row.centre);
          if (judged) spoken_[r]->verdict = verdict;
          std::size_t place = 0;
          for (const std::uint32_t b : rows_[r].buildings) {
            if (!searchable(b)) continue;
            const RoofView& roof = row.roofs[place];
            RefinedOutline& refined = row.refined[place++];
            const bool first = out.outlines[b].state == RowState::outside;
            if (surest || (!judged && first && roof.pixels > 0)) {
              out.outlines[b] = receipt(image, static_cast<std::uint32_t>(r), b, row.match, verdict, row.centre);
              if (verdict.state == row.verdict.state) out.outlines[b].refined = std::move(refined);
            }
            if (roof.pixels > 0 && (surest || out.roofs[b].pixels == 0))
              out.roofs[b] = roof, out.roofs[b].image = image;
          }
        });
    judge_roofs(image, out);
  }

  SeenPlace seen_place(std::uint32_t image, const Verdict& verdict, const RowMatch& match, Point2 centre) const {
    return {verdict, match.shift, images_[image].describe().source.date, field_.per_metre(centre).value_or(Point2{})};
  }

  /// What the images before said of a row is judged anew.
  void revise(const footprints::TerraceRowPlan& plan, const Verdict& verdict, ImageryObservations& out) const {
    for (const std::uint32_t b : plan.buildings) {
      if (!searchable(b) || out.outlines[b].image == OutlineReceipt::kNoImage) continue;
      if (verdict.state != out.outlines[b].state) restate(out.outlines[b], verdict.state, verdict.reason);
      out.outlines[b].confidence = rounded(verdict.confidence, 1000);
    }
  }

  /// When all roofs of an image were looked at, they tell where its sun stood.
  static void judge_roofs(std::uint32_t image, ImageryObservations& out) {
    std::vector<std::uint32_t> here;
    std::vector<RoofView> roofs;
    for (std::uint32_t b = 0; b < out.roofs.size(); ++b)
      if (out.roofs[b].image == image && out.roofs[b].pixels > 0) here.push_back(b), roofs.push_back(out.roofs[b]);
    const std::optional<double> sun = sun_azimuth(roofs);
    out.images[image].sun_azimuth = sun;
    if (sun)
      for (const std::uint32_t b : here) judge_roof(out.roofs[b], *sun);
    // As imagery.json has them: a tile that is built alone reads them there.
    for (const std::uint32_t b : here) {
      RoofView& roof = out.roofs[b];
      for (double* p : {&roof.colour_confidence, &roof.form_confidence, &roof.ridge_confidence}) *p = rounded(*p, 100);
      if (roof.ridge) roof.ridge = std::fmod(rounded(*roof.ridge, 10), 180);
    }
  }

  OutlineReceipt receipt(std::uint32_t image, std::uint32_t row, std::uint32_t building, const RowMatch& m,
                         const Verdict& verdict, Point2 centre) const {
    // Rounded as imagery.json has them: whoever reads them there moves buildings by the same.
    OutlineReceipt receipt;
    receipt.state = verdict.state, receipt.reason = std::string(verdict.reason);
    receipt.confidence = rounded(verdict.confidence, 1000);
    receipt.row = row;
    receipt.image = image;
    receipt.shift = rounded(m.shift), receipt.centre = rounded(centre);
    receipt.turn = rounded(m.turn, 100);
    receipt.before = rounded(m.here, 10000), receipt.after = rounded(m.best, 10000);
    receipt.mean = m.mean, receipt.deviation = m.deviation, receipt.second = m.second, receipt.weight = m.weight;
    receipt.height_doubt = m.height_doubt;
    const double eaves = eaves_.height(building);
    receipt.lean = rounded(field_.at(of_.footprints[building].box.centre(), eaves).value_or(Point2{}));
    receipt.eaves = rounded(eaves, 10);
    return receipt;
  }

  /// Other buildings near one, moved by the lean of its roof: some may stand in its courtyards.
  std::vector<model::Polygon> inside_of(std::uint32_t building, Point2 lean) const {
    std::vector<model::Polygon> out;
    for (const std::uint32_t b : index_.near(of_.footprints[building].box, 0)) {
      if (b == building || of_.footprints[b].settled != model::ObjectState::pending) continue;
      for (model::Polygon& polygon : of_.footprints.polygons(b)) {
        const auto move = [lean](model::Ring& ring) {
          for (Point2& p : ring.points) p.x += lean.x, p.y += lean.y;
        };
        move(polygon.outer);
        for (model::Ring& hole : polygon.holes) move(hole);
        out.push_back(std::move(polygon));
      }
    }
    return out;
  }

  /// Looks at each roof where the image shows it: at the place that was found, or, where that is not sure, as mapped.
  void look_at_roofs(const footprints::TerraceRowPlan& plan, const SearchedRow& row, const ImageWindows& windows,
                     const RowMatch& match, const Verdict& verdict, std::vector<RoofView>& roofs) const {
    footprints::Movement movement{{}, row.centre, 0};
    if (verdict.state == RowState::corrected) movement.shift = match.shift, movement.turn = match.turn;
    std::size_t place = 0;
    for (const std::uint32_t b : plan.buildings) {
      if (!searchable(b)) continue;
      const SearchedOutline& o = row.outlines[place];
      Point2 lean = o.lean;
      if (verdict.state == RowState::corrected && place < match.heights.size()) {
        const double by = match.heights[place] - o.height;
        lean.x += by * o.per_metre.x, lean.y += by * o.per_metre.y;
      }
      ++place;
      std::vector<model::Polygon> polygons = of_.footprints.polygons(b);
      for (model::Polygon& polygon : polygons) {
        const auto move = [&](model::Ring& ring) {
          for (Point2& p : ring.points) p = movement(p), p.x += lean.x, p.y += lean.y;
        };
        move(polygon.outer);
        for (model::Ring& hole : polygon.holes) move(hole);
      }
      roofs.push_back(look_at_roof(polygons, windows));
      if (std::ranges::any_of(polygons, [](const model::Polygon& p) { return !p.holes.empty(); }))
        roofs.back().courtyards = look_at_courtyards(polygons, inside_of(b, lean), windows);
    }
  }

  /// How many houses have a corner, of all corners in a row with several; empty for a house that stands alone.
  std::map<Point2, int> shared_corners(const footprints::TerraceRowPlan& plan) const {
    std::map<Point2, int> corners;
    if (plan.buildings.size() + plan.beyond.size() < 2) return corners;
    for (const auto* part : {&plan.buildings, &plan.beyond})
      for (const std::uint32_t b : *part)
        of_.footprints.for_each_ring(b, [&](std::span<const Point2> ring, bool) {
          for (const Point2 p : ring) ++corners[p];
        });
    return corners;
  }

  /// The walls of the row's houses, where the row was found or, if it is left alone, as mapped. By outline.
  std::vector<RefinedOutline> refine_row(const footprints::TerraceRowPlan& plan, const SearchedRow& row,
                                         const ImageWindows& windows, const RowMatch& match,
                                         const Verdict& verdict) const {
    std::vector<RefinedOutline> refined(row.outlines.size());
    const bool corrected = verdict.state == RowState::corrected;
    if (refine_within_ <= 0 || !(corrected || verdict.state == RowState::left_alone)) return refined;
    const double beside = std::sqrt(match.shift.x * match.shift.x + match.shift.y * match.shift.y);
    if (std::ranges::any_of(row.outlines, [](const SearchedOutline& o) { return o.pieces.empty(); })) return refined;
    const std::map<Point2, int> corners = shared_corners(plan);
    footprints::Movement movement{{}, rounded(row.centre), 0};
    if (corrected) movement.shift = rounded(match.shift), movement.turn = rounded(match.turn, 100);
    std::size_t place = 0;
    for (const std::uint32_t b : plan.buildings) {
      if (!searchable(b)) continue;
      const SearchedOutline& o = row.outlines[place];
      RefinedOutline& out = refined[place];
      const double by = corrected && place < match.heights.size() ? match.heights[place] - o.height : 0;
      ++place;
      out.state = RefinementState::left_alone;
      if (!corrected && beside >= kLeastCorrection) {
        out.reason = "its place is not sure enough";
        continue;
      }
      if (of_.footprints[b].has_parts) {
        out.reason = "its parts are mapped";
        continue;
      }
      Rings from;
      const Point2 lean{o.lean.x - o.ground.x, o.lean.y - o.ground.y};
      RefinedBuilding building{.rings = {}, .fixed = {}, .seen = o.lean, .lean = lean, .doubt = o.per_metre};
      of_.footprints.for_each_ring(b, [&](std::span<const Point2> ring, bool) {
        from.emplace_back(), building.fixed.emplace_back();
        for (const Point2 p : ring) {
          from.back().push_back(rounded(p));
          const auto found = corners.find(p);
          building.fixed.back().push_back(found != corners.end() && found->second > 1);
        }
      });
      building.rings = from;
      for (std::vector<Point2>& ring : building.rings)
        for (Point2& p : ring) p = movement(p);
      building.lean.x += by * o.per_metre.x, building.lean.y += by * o.per_metre.y;
      building.doubt.x *= o.height * o.uncertainty, building.doubt.y *= o.height * o.uncertainty;
      out = refine_edges(building, windows, refine_within_);
      if (out.state == RefinementState::refined) out.from = std::move(from);
    }
    return refined;
  }

  const ObservedExtract& of_;
  std::span<const importers::imagery::AerialImage> images_;
  Correction correct_;
  double refine_within_;  ///< m
  int workers_;
  base::Progress& progress_;
  std::vector<footprints::TerraceRowPlan> rows_;
  std::vector<std::uint32_t> row_of_;  ///< by building
  EavesHeights eaves_;
  footprints::BoxIndex index_;
  std::vector<std::optional<SeenPlace>> spoken_;  ///< by row: what the images so far say of it
  LeanField field_;
};

}  // namespace

ImageryObservations observe_extract(const ObservedExtract& of, std::span<const importers::imagery::AerialImage> images,
                                    Correction correct, double refine_within, int workers, base::Progress& progress) {
  return Observer(of, images, workers, correct, refine_within, progress).run();
}

}  // namespace blockrand::observation
