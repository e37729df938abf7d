#include "pipeline/outputs/report/report_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <future>
#include <iterator>
#include <map>
#include <tuple>

#include "pipeline/base/error.h"
#include "pipeline/base/text.h"
#include "pipeline/base/version.h"
#include "pipeline/outputs/buildings_here.h"
#include "pipeline/outputs/plan/plan_picture.h"
#include "pipeline/outputs/report/embedded_view.h"
#include "pipeline/outputs/report/houses.h"
#include "pipeline/outputs/report/pictures.h"
#include "pipeline/outputs/report/report_facts.h"
#include "pipeline/outputs/report/report_page.h"

namespace blockrand::outputs {
namespace {

/// What repair did, in words for the report.
std::vector<std::pair<std::string, std::string>> repair_lines(const footprints::RepairTotals& t) {
  using base::with_thousands;
  const auto of = [](std::uint64_t part, std::uint64_t whole) {
    return with_thousands(part) + " of " + with_thousands(whole);
  };
  const auto share = [](double ratio) { return fmt::format("{:.2f} %", 100 * ratio); };
  std::vector<std::pair<std::string, std::string>> out = {
      {"Outlines", with_thousands(t.outlines)},
      {"Rows of touching buildings", with_thousands(t.rows)},
      {"Corners moved", of(t.moved, t.vertices)},
      {"Mean, largest shift of those", fmt::format("{:.3f} m, {:.2f} m", t.mean_shift, t.max_shift)},
      {"Median, largest change of area", share(t.median_area_change) + ", " + share(t.max_area_change)},
      {"Shared walls", with_thousands(t.shared_walls)},
      {"Gaps closed", with_thousands(t.gaps_closed)},
      {"Overlaps resolved", with_thousands(t.overlaps_resolved)},
      {"Outlines with an overlap left", with_thousands(t.overlaps_left)},
      {"Outlines with a main direction", with_thousands(t.squared)},
      {"Curved walls", with_thousands(t.arcs)}};
  if (t.at_cuts > 0) out.emplace_back("Buildings at cuts of long rows", with_thousands(t.at_cuts));
  return out;
}

/// "Arkonaplatz, Ruppiner Straße and Granseer Straße": names of the streets around a block, the longest side first.
std::string streets_around(const context::Block& block, const std::vector<context::NetworkLine>& lines) {
  std::map<std::string_view, double> lengths;
  for (const context::BlockBorder& border : block.borders) {
    const context::NetworkLine& line = lines[border.line];
    if (context::is_street(line.kind) && !line.name.empty()) lengths[line.name] += border.length;
  }
  std::vector<std::pair<std::string_view, double>> names(lengths.begin(), lengths.end());
  std::ranges::stable_sort(names, std::greater<>(), [](const auto& name) { return name.second; });
  constexpr std::size_t kNamed = 4;
  std::string out;
  const std::size_t named = std::min(names.size(), kNamed);
  for (std::size_t i = 0; i < named; ++i) {
    if (i > 0) out += i + 1 == names.size() ? " and " : ", ";
    out += names[i].first;
  }
  if (names.size() > named) out += " and " + std::to_string(names.size() - named) + " more";
  return out;
}

/// Blocks of the buildings of this build, in rows from north to south, each from west to east.
std::vector<BlockFact> block_facts(const OutputContext& context) {
  const context::ContextExtract& c = context.context;
  const std::vector<bool> here = buildings_here(context.repaired, context.shards, context.alone);
  std::vector<std::uint64_t> all(c.blocks.size()), ours(c.blocks.size());
  for (std::size_t b = 0; b < c.block_of.size(); ++b) {
    if (c.block_of[b] == model::kNoIndex) continue;
    ++all[c.block_of[b]];
    if (here[b]) ++ours[c.block_of[b]];
  }
  constexpr double kRow = 200;  // m: the depth of a block with its street
  std::vector<std::tuple<std::int64_t, double, std::uint32_t>> order;
  for (std::uint32_t i = 0; i < c.blocks.size(); ++i) {
    if (ours[i] == 0) continue;
    double west = 1e300, north = -1e300;
    for (const model::Point2& p : c.blocks[i].polygon.outer.points)
      west = std::min(west, p.x), north = std::max(north, p.y);
    order.emplace_back(-static_cast<std::int64_t>(std::floor(north / kRow)), west, i);
  }
  std::ranges::sort(order);
  std::vector<BlockFact> out;
  for (const auto& [row, west, i] : order) {
    const context::Block& block = c.blocks[i];
    BlockFact fact{block.id, streets_around(block, c.lines), block.area, block.gives_ratios(), all[i], {}};
    const auto ring = [&](const model::Ring& r) {
      fact.rings.emplace_back();
      for (const model::Point2& p : r.points) fact.rings.back().emplace_back(p.x, p.y);
    };
    ring(block.polygon.outer);
    for (const model::Ring& hole : block.polygon.holes) ring(hole);
    out.push_back(std::move(fact));
  }
  return out;
}

/// Everything but the pictures.
ReportFacts report_facts(const OutputContext& context, const FinishedBuild& build, const ReportBuilder& page) {
  ReportFacts f;
  f.name = context.name;
  f.data_time = context.data_time;
  f.attribution = attribution(context);
  f.program_version = base::kVersion;
  f.crs_code = context.crs.authority_code;
  f.crs_name = context.crs.name;
  f.crs_accuracy = context.crs.accuracy_m;
  f.height_reference = context.heights.words;
  f.vertical_crs = context.heights.vertical_crs;
  f.lod = context.lod;
  f.centre_longitude = context.centre.lon;
  f.centre_latitude = context.centre.lat;
  const ObjectCounts& s = build.counts;
  f.buildings_in = s.buildings_in;
  f.parts_in = s.parts_in;
  f.models = s.models;
  f.represented = s.represented;
  f.duplicates = s.duplicates;
  f.reported = s.reported;
  f.models_by_lod = s.models_by_lod;
  f.buildings_built = page.buildings_built();
  f.bodies = page.bodies();
  const Statistics& t = build.statistics;
  f.sources = t.sources;
  f.roofs = t.roofs;
  f.footprint_area = t.footprint_area;
  f.outer_wall_area = t.outer_wall_area;
  f.party_wall_area = t.party_wall_area;
  f.party_wall_length = t.party_wall_length;
  f.volume = t.volume;
  f.party_walls = t.party_walls;
  if (context.repaired.totals.outlines > 0) f.context.repair = repair_lines(context.repaired.totals);
  f.context.edges = t.edges;
  f.context.edge_length = t.edge_length;
  f.context.positions = t.positions;
  f.blocks = block_facts(context);
  f.alone = context.alone.has_value();
  f.rows = build.rows;
  for (const model::MappedBuilding& b : context.extract.buildings)
    if (b.state != model::ObjectState::modelled) f.objects.push_back({b.id, b.kind, b.state, b.code, b.related});
  for (const base::PublishedFile& file : build.files) f.files.push_back({file.path, file.bytes});
  return f;
}

PlanWords plan_words(const OutputContext& context, std::uint64_t buildings) {
  // Of an area neither count nor date: it would be drawn anew with every edit of it.
  const std::string about =
      context.alone
          ? context.crs.name + (context.crs.authority_code.empty() ? "" : " (" + context.crs.authority_code + ")")
          : about_words(buildings, context.data_time, context.crs);
  return {context.name, about, attribution(context), generator()};
}
constexpr const char* kTable = "buildings.csv";

/// What a tile gives to the page.
struct TileShare {
  ReportTile page;
  std::string table;  ///< lines of buildings.csv
  PackedPictureTile picture;
  picture::PlanTile plan;
};

class ReportOutput : public OutputOf<TileShare> {
 public:
  explicit ReportOutput(const OutputContext& context)
      : context_(context),
        picture_plan_(plan_pictures(context.shards, context.repaired, context.projection)),
        pictures_(picture_plan_),
        plan_choice_(choose_plan(context.shards, context.projection, picture_plan_)),
        table_(context.folder.create(kTable)) {
    table_.append(csv_head());
  }

  std::any write_tile(FinishedTile& tile) const override {
    TileShare share;
    share.page = report_tile(tile.region);
    share.table = csv_lines(tile.region, share.page, context_.projection);
    share.picture = pack_picture(picture_tile(tile.region, picture_plan_, tile.shard), context_.memo != nullptr);
    if (plan_choice_.chosen[tile.shard]) share.plan = picture::plan_tile(tile.region);
    return share;
  }
  std::string reads_of_tile(std::size_t shard) const override {
    base::Packer packer;
    const bool pictured = picture_plan_.chosen[shard];
    packer << pictured << plan_choice_.chosen[shard];
    if (pictured) packer << picture_plan_.origin;
    packer << picture_plan_.near_spot[shard];
    if (picture_plan_.near_spot[shard]) packer << picture_plan_.spot;
    return std::move(packer.bytes);
  }
  void take(const FinishedTile&, std::any product) override {
    TileShare& share = *std::any_cast<TileShare>(&product);
    table_.append(share.table);
    page_.add(std::move(share.page));
    pictures_.add(std::move(share.picture));
    if (!share.plan.buildings.empty()) plans_.push_back(std::move(share.plan));
  }
  void begin_finish(const FinishedBuild&) override {
    drawn_ = std::async(context_.workers > 1 ? std::launch::async : std::launch::deferred,
                        [this] { return pictures_.take(context_.workers, context_.memo, attribution(context_)); });
  }
  /// The page lists the files of all outputs.
  void conclude(const FinishedBuild& build) override {
    std::ranges::sort(build.files, {}, &base::PublishedFile::path);
    std::optional<EmbeddedModel> embedded = model(build);
    PlanSheet plan = draw_plan(std::move(plans_), context_.context, plan_choice_, context_.projection,
                               plan_words(context_, page_.buildings_built()), context_.memo);
    if (!plan.png.empty()) build.files.push_back(context_.folder.write("plan.png", plan.png));
    build.files.push_back(table_.close());
    std::ranges::sort(build.files, {}, &base::PublishedFile::path);
    ReportFacts facts = report_facts(context_, build, page_);
    if (!plan.png.empty()) facts.context.plan = std::move(plan.in_report);
    facts.context.plan_note = std::move(plan.note);
    facts.pictures_note = pictures_.note();
    facts.pictures = drawn_.get();
    facts.model = std::move(embedded);
    build.files.push_back(context_.folder.write("report.html", page_.html(facts)));
  }

 private:
  /// The 3D Tiles of a small build, for the page itself; nothing for a part of a larger build.
  std::optional<EmbeddedModel> model(const FinishedBuild& build) const {
    if (context_.alone) return std::nullopt;
    ViewRecord view;
    view.name = context_.name;
    view.lod = context_.lod;
    view.buildings = build.statistics.buildings;
    view.attribution = attribution(context_);
    view.data_time = context_.data_time;
    const auto read = [&](const std::string& path) {
      const std::string place = context_.folder.staging_path() + "/" + path;
      std::ifstream file(place, std::ios::binary | std::ios::ate);
      std::string content;
      if (file.is_open()) content.resize(static_cast<std::size_t>(std::max<std::streamoff>(0, file.tellg())));
      file.seekg(0);
      file.read(content.data(), static_cast<std::streamsize>(content.size()));
      if (!file) throw base::OutputError(place + ": cannot be read back");
      return content;
    };
    std::optional<std::string> files = embedded_view(build.files, read, std::move(view));
    if (!files) return std::nullopt;
    return EmbeddedModel{std::move(*files), embedded_viewer()};
  }

  const OutputContext& context_;
  PicturePlan picture_plan_;
  Pictures pictures_;
  PlanChoice plan_choice_;
  std::vector<picture::PlanTile> plans_;
  base::StagedFile table_;
  ReportBuilder page_;
  std::future<std::vector<ReportPicture>> drawn_;  ///< the last member: it waits for its thread before the others go
};

}  // namespace

OutputFormat report_output() {
  return {.name = "report",
          .in_formats = false,
          .places = {{"report.html", "what was built, where values come from, a map and pictures"},
                     {kTable, "every building in a line, for spreadsheets"},
                     {"plan.png", "seen from above, walls in the colours of what they face",
                      [](const OutputOptions&, std::uint64_t models) { return models > 0; }}},
          .manual = {{"report.html",
                      "what was built, where values come from, what fell back and why, with a map and pictures"},
                     {kTable,
                      "every building in a line: address, use, storeys, height, roof, style, era, floor area, "
                      "block, and where values come from; opens in any spreadsheet"},
                     {"plan.png",
                      "the neighbourhood from above: blocks, courtyards, walls in the colours of what they face"}},
          .asked = [](const OutputOptions& o) { return o.report; },
          .size = [](const OutputOptions&,
                     std::size_t) { return OutputSize{.once = 4e6, .per_building = 450, .memory = 20e6}; },
          .open = [](const OutputContext& c) -> std::unique_ptr<Output> { return std::make_unique<ReportOutput>(c); }};
}

}  // namespace blockrand::outputs
