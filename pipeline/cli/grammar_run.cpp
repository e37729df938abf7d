// Rule files on a rectangular lot: run and tested from the command line.
#include "pipeline/cli/grammar_run.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "pipeline/base/error.h"
#include "pipeline/base/version.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/export/gltf/triangle_glb.h"
#include "pipeline/geometry/triangulate.h"
#include "styles/grammar/colour_text.h"
#include "styles/grammar/derive.h"
#include "styles/grammar/initial_shape.h"
#include "styles/grammar/rule_tests.h"
#include "styles/grammar/scope.h"
#include "styles/grammar/value_text.h"

namespace blockrand::cli {
namespace {

namespace fs = std::filesystem;

/// Steps per metre for triangulation: finer than any moulding, and exact up to 32 km (pipeline/geometry/grid.h).
constexpr double kStepsPerMetre = 65536;

struct Arguments {
  std::vector<std::string> files, roots;
  double width = 10, depth = 10;
  bool tree = false;
  std::string output;
  grammar::DeriveOptions options;
  std::optional<double> storeys;
};

double number_of(const std::string& option, const std::string& text) {
  double out = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), out);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size())
    throw base::UsageError(fmt::format("{} needs a number, not '{}'", option, text));
  return out;
}

Arguments read_arguments(const std::vector<std::string>& words, bool run) {
  Arguments out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word.empty() || word[0] != '-' || word == "-") {
      out.files.push_back(word);
      continue;
    }
    const std::size_t equals = word.starts_with("--") ? word.find('=') : std::string::npos;
    const std::string option = word.substr(0, equals);
    const auto value = [&]() -> std::string {
      if (equals != std::string::npos) return word.substr(equals + 1);
      if (i + 1 >= words.size()) throw base::UsageError(option + " needs a value. Try 'blockrand grammar --help'.");
      return words[++i];
    };
    if (option == "--roots") {
      const std::string list = value();
      for (std::size_t at = 0; at <= list.size();) {
        const std::size_t end = std::min(list.find(',', at), list.size());
        if (end > at) out.roots.push_back(list.substr(at, end - at));
        at = end + 1;
      }
    } else if (!run) {
      throw base::UsageError(fmt::format("grammar test knows no {}. Try 'blockrand grammar --help'.", option));
    } else if (option == "--lot") {
      const std::string lot = value();
      if (!grammar::read_lot(lot, out.width, out.depth))
        throw base::UsageError(fmt::format("--lot needs metres such as 20x12, not '{}'", lot));
    } else if (option == "--storeys") {
      out.storeys = number_of(option, value());
    } else if (option == "--seed") {
      const std::string text = value();
      const auto read = std::from_chars(text.data(), text.data() + text.size(), out.options.seed);
      if (read.ec != std::errc() || read.ptr != text.data() + text.size())
        throw base::UsageError(fmt::format("--seed needs a whole number, not '{}'", text));
    } else if (option == "--attr") {
      const std::string text = value();
      const std::size_t sign = text.find('=');
      if (sign == std::string::npos || sign == 0)
        throw base::UsageError(fmt::format("--attr needs NAME=VALUE, not '{}'", text));
      out.options.attributes.emplace_back(text.substr(0, sign),
                                          grammar::read_value(std::string_view(text).substr(sign + 1)));
    } else if (option == "--rule") {
      out.options.start_rule = value();
    } else if (option == "--tree") {
      out.tree = true;
    } else if (option == "-o" || option == "--output") {
      out.output = value();
    } else {
      throw base::UsageError(fmt::format("grammar run knows no {}. Try 'blockrand grammar --help'.", option));
    }
  }
  return out;
}

std::optional<std::string> read_file(const std::string& path) {
  std::error_code none;
  if (!fs::is_regular_file(path, none)) return std::nullopt;
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  std::ostringstream out;
  out << in.rdbuf();
  return std::move(out).str();
}

grammar::Program load_program(const std::string& file, const Arguments& arguments) {
  grammar::LoadOptions options;
  for (const std::string& root : arguments.roots) {
    const std::size_t equals = root.starts_with('/') ? root.find('=') : std::string::npos;
    if (equals == std::string::npos)
      options.roots.push_back(root);
    else
      options.mounts.emplace_back(root.substr(0, equals), root.substr(equals + 1));
  }
  options.read = read_file;
  options.list = [](const std::string& folder) {
    std::vector<std::string> out;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, none))
      out.push_back(entry.path().filename().string());
    return out;
  };
  return grammar::load(file, options);
}

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
  if (shape.mesh == nullptr) return;
  const grammar::Frame frame = grammar::scope_in_world(shape);
  std::vector<grammar::Vector3> points;
  for (const grammar::Vector3& v : shape.mesh->vertices) points.push_back(grammar::place(frame, v));
  for (const grammar::MeshFace& face : shape.mesh->faces) {
    if (face.loops.empty()) continue;
    // Newell's normal of the outline: the axis to look along.
    grammar::Vector3 normal;
    const auto& outline = face.loops.front();
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const grammar::Vector3 &a = points[outline[i].vertex], &b = points[outline[(i + 1) % outline.size()].vertex];
      normal =
          normal + grammar::Vector3{(a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x), (a.x - b.x) * (a.y + b.y)};
    }
    const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
    const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    const bool turned = grammar::component(normal, axis) < 0;
    std::vector<geometry::Grid2> plane;
    std::vector<std::uint32_t> vertices;
    std::vector<std::vector<std::uint32_t>> loops;
    for (const auto& loop : face.loops) {
      loops.emplace_back();
      for (const grammar::Corner& corner : loop) {
        const grammar::Vector3& p = points[corner.vertex];
        double u = grammar::component(p, (axis + 1) % 3), v = grammar::component(p, (axis + 2) % 3);
        if (turned) std::swap(u, v);
        loops.back().push_back(static_cast<std::uint32_t>(plane.size()));
        plane.push_back({std::llround(u * kStepsPerMetre), std::llround(v * kStepsPerMetre)});
        vertices.push_back(corner.vertex);
      }
    }
    const auto add = [&](std::uint32_t corner) {
      const grammar::Vector3& p = points[vertices[corner]];
      out.push_back({p.x, p.y, p.z});
    };
    if (const auto triangles = geometry::triangulate(plane, loops)) {
      for (const auto& triangle : *triangles)
        for (const std::uint32_t corner : triangle) add(corner);
    } else {  // not simple in projection: a fan shows at least what is there
      for (std::uint32_t i = 1; i + 1 < loops[0].size(); ++i) add(loops[0][0]), add(loops[0][i]), add(loops[0][i + 1]);
    }
  }
}

std::string glb_of(const grammar::Derivation& result) {
  std::map<std::string, export_::ColouredTriangles> groups;
  for (const grammar::Leaf& leaf : result.leaves) {
    const grammar::Material material = leaf.shape.material != nullptr ? *leaf.shape.material : grammar::Material();
    const std::string name = grammar::colour_text(material.colour, true);
    export_::ColouredTriangles& group = groups[name];
    group.name = name;
    group.colour = material.colour;
    group.roughness = material.roughness;
    group.metallic = material.metallic;
    append_triangles(leaf.shape, group.corners);
  }
  std::vector<export_::ColouredTriangles> all;
  for (auto& [name, group] : groups) all.push_back(std::move(group));
  return export_::write_triangle_glb(all, "blockrand " BLOCKRAND_VERSION, /*y_up=*/true);
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

int run_grammar_run(const std::vector<std::string>& words) {
  Arguments arguments = read_arguments(words, /*run=*/true);
  if (arguments.files.size() != 1)
    throw base::UsageError("grammar run needs one rule file. Try 'blockrand grammar --help'.");
  const grammar::Program program = load_program(arguments.files[0], arguments);
  std::size_t errors = print_diagnostics(program.diagnostics, program, false);
  if (program.modules.empty()) return kInvalidInput;
  if (arguments.storeys) {
    arguments.options.attributes.emplace_back("building__levels", *arguments.storeys);
    arguments.options.attributes.emplace_back("building.storeys", *arguments.storeys);
  }
  arguments.options.keep_tree = arguments.tree;
  const grammar::Shape lot = grammar::initial_shape(
      {{0, 0, 0}, {arguments.width, 0, 0}, {arguments.width, 0, -arguments.depth}, {0, 0, -arguments.depth}});
  const grammar::Derivation result = grammar::derive(program, lot, arguments.options);
  std::vector<grammar::Diagnostic> told;
  for (const grammar::Diagnostic& d : result.diagnostics)
    if (d.code != "unused_value" || d.text != "building__levels") told.push_back(d);
  errors += print_diagnostics(told, program, true);
  print_result(result, arguments.tree);
  if (!arguments.output.empty()) {
    std::ofstream out(arguments.output, std::ios::binary);
    out << glb_of(result);
    out.close();
    if (!out)
      throw base::OutputError(arguments.output + ": cannot be written. Check the folder and the space on the disk");
  }
  return errors > 0 ? kInvalidInput : kSuccess;
}

int run_grammar_test(const std::vector<std::string>& words) {
  const Arguments arguments = read_arguments(words, /*run=*/false);
  if (arguments.files.empty()) throw base::UsageError("grammar test needs rule files. Try 'blockrand grammar --help'.");
  std::size_t failed = 0, count = 0;
  for (const std::string& file : arguments.files) {
    const grammar::Program program = load_program(file, arguments);
    if (program.modules.empty()) {
      failed += print_diagnostics(program.diagnostics, program, false);
      continue;
    }
    const std::vector<grammar::RuleTest> tests = grammar::read_rule_tests(program.files[program.unit(0).file].text);
    if (tests.empty()) fmt::print("{}: nothing is expected\n", file);
    for (const grammar::RuleTest& test : tests) {
      ++count;
      const grammar::RuleTestOutcome outcome = grammar::run_rule_test(program, test);
      if (!outcome.failures.empty()) ++failed;
      for (const std::string& failure : outcome.failures) fmt::print("{}:{}: {}\n", file, outcome.line, failure);
    }
  }
  fmt::print("{} of {} expectations hold\n", count >= failed ? count - failed : 0, count);
  return failed > 0 ? kInvalidInput : kSuccess;
}

}  // namespace blockrand::cli
