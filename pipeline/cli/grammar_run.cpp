// Rule files on a rectangular lot: run and tested from the command line.
#include "pipeline/cli/grammar_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/base/error.h"
#include "pipeline/base/version.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/grammar_walls.h"
#include "pipeline/cli/rule_files.h"
#include "pipeline/outputs/gltf/triangle_glb.h"
#include "styles/grammar/evaluation/colour_text.h"
#include "styles/grammar/evaluation/derive.h"
#include "styles/grammar/evaluation/rule_tests.h"
#include "styles/grammar/language/value_text.h"
#include "styles/grammar/shapes/initial_shape.h"
#include "styles/grammar/shapes/mesh_triangles.h"
#include "styles/grammar/shapes/occlusion.h"

namespace blockrand::cli {
namespace {

/// Of a house for --edge and --block.
constexpr double kUsualStoreys = 4;

/// \returns the number of errors
std::size_t print_diagnostics(const std::vector<grammar::Diagnostic>& diagnostics, const grammar::Program& program,
                              bool symbols_told) {
  std::size_t errors = 0;
  for (const grammar::Diagnostic& d : diagnostics) {
    // Loading has warned of symbols without rule already.
    if (symbols_told && d.code == "no_rule") continue;
    fmt::print(stderr, "{}\n", grammar::format(d, program.files));
    errors += d.severity == grammar::Severity::error;
  }
  return errors;
}

/// Triangles of a shape's faces in the world's axes, three corners each.
void append_triangles(const grammar::Shape& shape, std::vector<model::Point3>& out) {
  const grammar::Mesh mesh = grammar::mesh_in_world(shape);
  for (const grammar::MeshTriangle& triangle : grammar::triangles_of(mesh))
    for (const std::uint32_t vertex : triangle.vertices) {
      const grammar::Vector3& p = mesh.vertices[vertex];
      out.push_back({p.x, p.y, p.z});
    }
}

/// Leaves by colour. \param house  whose walls they are: leaves that order elements are left out, those without looks are its wall
void add_leaves(const grammar::Derivation& result, const TrialHouse* house,
                std::map<std::string, outputs::ColouredTriangles>& groups) {
  grammar::Material bare;
  if (house) {
    const model::Colour c = house->part().attributes.shown_wall_colour;
    bare.colour = {c.r / 255.0, c.g / 255.0, c.b / 255.0, 1};
  }
  for (const grammar::Leaf& leaf : result.leaves) {
    if (house && leaf.order) continue;
    const grammar::Material material = leaf.shape.material != nullptr ? *leaf.shape.material : bare;
    const std::string name = grammar::colour_text(material.colour, true);
    outputs::ColouredTriangles& group = groups[name];
    group.name = name;
    group.colour = material.colour;
    group.roughness = material.roughness;
    group.metallic = material.metallic;
    append_triangles(leaf.shape, group.corners);
  }
}

/// \param house  whose walls the derivations began with; null: elements are their leaves' faces
std::string glb_of(std::span<const grammar::Derivation> results, const TrialHouse* house,
                   const elements::ElementCatalogue& elements, std::vector<std::string>& complaints) {
  std::map<std::string, outputs::ColouredTriangles> groups;
  std::vector<outputs::ColouredTriangles> all;
  for (const grammar::Derivation& result : results) {
    add_leaves(result, house, groups);
    if (!house) continue;
    for (outputs::ColouredTriangles& group : element_triangles(result, *house, elements, complaints))
      all.push_back(std::move(group));
  }
  for (auto& [name, group] : groups) all.push_back(std::move(group));
  return outputs::write_triangle_glb(all, "blockrand " BLOCKRAND_VERSION, /*y_up=*/true);
}

void print_result(const grammar::Derivation& result, bool tree) {
  for (const std::string& line : result.prints) fmt::print("{}\n", line);
  if (tree)
    for (std::uint32_t i = 0; i < result.tree.size(); ++i) {
      const grammar::TreeNode& node = result.tree[i];
      fmt::print("{:{}}{} {} ({} x {} x {})\n", "", 2 * node.depth, grammar::tree_key(result, i), node.symbol,
                 grammar::number_text(node.shape.size.x), grammar::number_text(node.shape.size.y),
                 grammar::number_text(node.shape.size.z));
    }
  if (!result.reports.empty())
    fmt::print("{:<32}{:>10}{:>14}{:>12}{:>12}{:>12}\n", "report", "count", "sum", "mean", "min", "max");
  for (const grammar::Report& r : result.reports)
    fmt::print("{:<32}{:>10}{:>14.3f}{:>12.3f}{:>12.3f}{:>12.3f}\n", r.key, r.count, r.sum, r.mean, r.minimum,
               r.maximum);
  std::map<std::string, std::size_t> symbols;
  for (const grammar::Leaf& leaf : result.leaves) ++symbols[leaf.symbol];
  fmt::print("{} leaves of {} shapes\n", result.leaves.size(), result.shapes);
  for (const auto& [symbol, count] : symbols) fmt::print("  {:<32}{:>8}\n", symbol, count);
}

/// The house whose walls --edge and --block ask for.
std::optional<TrialHouse> trial_house(const settings::Settings& s, double width, double depth) {
  if (s.rule_edge.empty() && !s.rule_block) return std::nullopt;
  constexpr std::pair<const char*, model::WallSegmentKind> kKinds[] = {{"street", model::WallSegmentKind::street},
                                                                       {"courtyard", model::WallSegmentKind::courtyard},
                                                                       {"side", model::WallSegmentKind::side},
                                                                       {"passage", model::WallSegmentKind::passage}};
  const std::string kind = s.rule_edge.empty() ? "street" : s.rule_edge;
  const auto known = std::ranges::find(kKinds, kind, [](const auto& k) { return std::string(k.first); });
  if (known == std::end(kKinds))
    throw base::UsageError("--edge: '" + kind + "' is unknown. Known: street, courtyard, side, passage.");
  if (width < 1 || depth < 1) throw base::UsageError("--edge and --block need a --lot of a metre at least.");
  return std::optional<TrialHouse>(std::in_place, width, depth, std::max(1.0, s.rule_storeys.value_or(kUsualStoreys)),
                                   known->second);
}

}  // namespace

int run_grammar_run(const settings::Settings& s) {
  if (s.rule_files.size() != 1)
    throw base::UsageError("grammar run needs one rule file. Try 'blockrand grammar --help'.");
  double width = 0, depth = 0;
  if (!grammar::read_lot(s.rule_lot, width, depth))
    throw base::UsageError(fmt::format("--lot needs metres such as 20x12, not '{}'", s.rule_lot));
  if (std::error_code none; !s.build.output.empty() && std::filesystem::exists(s.build.output, none) && !s.build.force)
    throw base::UsageError(s.build.output + " exists already. Choose another file with -o, or --force");
  const std::string& file = s.rule_files[0];
  const grammar::Program program = grammar::load(file, rule_load_options(s, file));
  std::size_t errors = print_diagnostics(program.diagnostics, program, false);
  if (program.modules.empty()) return kInvalidInput;
  grammar::DeriveOptions options;
  options.seed = options.building_seed = options.row_seed = s.build.seed;
  options.start_rule = s.start_rule;
  options.keep_tree = s.rule_tree;
  const grammar::FileAccess files = rule_file_access(s, file);
  options.files = &files;
  for (const std::string& given : s.rule_attributes) {
    const std::size_t equals = given.find('=');
    options.attributes.emplace_back(given.substr(0, equals),
                                    grammar::read_value(std::string_view(given).substr(equals + 1)));
  }
  if (s.rule_storeys) {
    const auto storeys = static_cast<double>(*s.rule_storeys);
    options.attributes.emplace_back("building__levels", storeys);
    options.attributes.emplace_back("building.storeys", storeys);
  }
  const std::optional<TrialHouse> house = trial_house(s, width, depth);
  std::vector<grammar::Derivation> results;
  if (house) {
    for (const TrialWall& wall : house->walls(s.rule_block)) {
      options.source = house->values(wall.wall);
      results.push_back(grammar::derive(program, wall.shape, options));
    }
  } else {
    results.push_back(grammar::derive(
        program, grammar::initial_shape({{0, 0, 0}, {width, 0, 0}, {width, 0, -depth}, {0, 0, -depth}}), options));
  }
  for (const grammar::Derivation& result : results) {
    std::vector<grammar::Diagnostic> told;
    for (const grammar::Diagnostic& d : result.diagnostics)
      if (d.code != "unused_value" || d.text != "building__levels") told.push_back(d);
    errors += print_diagnostics(told, program, true);
    print_result(result, s.rule_tree);
  }
  std::vector<std::string> complaints;
  const elements::ElementCatalogue elements = house ? rule_elements(s, file) : elements::ElementCatalogue();
  const std::string glb = glb_of(results, house ? &*house : nullptr, elements, complaints);
  for (const std::string& what : complaints) fmt::print(stderr, "{}: {}\n", file, what);
  errors += complaints.size();
  if (!s.build.output.empty()) {
    std::ofstream out(s.build.output, std::ios::binary);
    out << glb;
    out.close();
    if (!out)
      throw base::OutputError(s.build.output + ": cannot be written. Check the folder and the space on the disk");
  }
  return errors > 0 ? kInvalidInput : kSuccess;
}

int run_grammar_test(const settings::Settings& s) {
  std::size_t failed = 0, count = 0;
  for (const std::string& file : s.rule_files) {
    const grammar::Program program = grammar::load(file, rule_load_options(s, file));
    if (program.modules.empty()) {
      failed += print_diagnostics(program.diagnostics, program, false);
      continue;
    }
    const grammar::FileAccess files = rule_file_access(s, file);
    const std::vector<grammar::RuleTest> tests = grammar::read_rule_tests(program.files[program.unit(0).file].text);
    if (tests.empty()) fmt::print("{}: nothing is expected\n", file);
    for (grammar::RuleTest test : tests) {
      ++count;
      test.options.files = &files;
      const grammar::RuleTestOutcome outcome = grammar::run_rule_test(program, test);
      if (!outcome.failures.empty()) ++failed;
      for (const std::string& failure : outcome.failures) fmt::print("{}:{}: {}\n", file, outcome.line, failure);
    }
  }
  fmt::print("{} of {} expectations hold\n", count >= failed ? count - failed : 0, count);
  return failed > 0 ? kInvalidInput : kSuccess;
}

}  // namespace blockrand::cli
