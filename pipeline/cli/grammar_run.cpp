// Rule files on a rectangular lot: run and tested from the command line.
#include "pipeline/cli/grammar_run.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "pipeline/base/error.h"
#include "pipeline/base/version.h"
#include "pipeline/cli/exit_codes.h"
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

std::string glb_of(const grammar::Derivation& result) {
  std::map<std::string, outputs::ColouredTriangles> groups;
  for (const grammar::Leaf& leaf : result.leaves) {
    const grammar::Material material = leaf.shape.material != nullptr ? *leaf.shape.material : grammar::Material();
    const std::string name = grammar::colour_text(material.colour, true);
    outputs::ColouredTriangles& group = groups[name];
    group.name = name;
    group.colour = material.colour;
    group.roughness = material.roughness;
    group.metallic = material.metallic;
    append_triangles(leaf.shape, group.corners);
  }
  std::vector<outputs::ColouredTriangles> all;
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
  const grammar::Shape lot = grammar::initial_shape({{0, 0, 0}, {width, 0, 0}, {width, 0, -depth}, {0, 0, -depth}});
  const grammar::Derivation result = grammar::derive(program, lot, options);
  std::vector<grammar::Diagnostic> told;
  for (const grammar::Diagnostic& d : result.diagnostics)
    if (d.code != "unused_value" || d.text != "building__levels") told.push_back(d);
  errors += print_diagnostics(told, program, true);
  print_result(result, s.rule_tree);
  if (!s.build.output.empty()) {
    std::ofstream out(s.build.output, std::ios::binary);
    out << glb_of(result);
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
