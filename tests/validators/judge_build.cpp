// Judges every solid of a finished build from its files: CityGML and GLB are read back and each solid is given to both
// judges, our own checker and CGAL.
//   judge_build OUT_FOLDER [--sample N]      N: every N-th file only, without the comparison of counts
// Prints a table, the first invalid solids with id and reason, every disagreement of the judges and every count that
// differs from build.json; the last line is the summary. Exit code 0 clean, 1 not, 2 wrong usage.
#include <fmt/format.h>
#include <libxml/parser.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/triangulate.h"
#include "tests/validators/citygml_reader.h"
#include "tests/validators/glb_reader.h"
#include "pipeline/geometry/second_judge.h"

namespace {

using namespace blockrand;
namespace fs = std::filesystem;
using model::Point3;

constexpr std::size_t kShown = 20;

/// What both judges said about the solids of one kind of file.
struct Tally {
  std::size_t checked = 0, invalid_own = 0, invalid_cgal = 0, disagreements = 0;
  std::vector<std::string> invalid, disagreeing;  ///< "tiles/15/1/2.glb w123: own: …; CGAL: …"
};

struct Findings {
  std::map<std::string, Tally> by_kind;     ///< "CityGML LoD1", "CityGML LoD2", "GLB"
  std::set<std::string> buildings;          ///< gml:id of bldg:Building
  std::set<std::string> modelled_gml, modelled_glb;  ///< objects that own a solid
  std::set<std::string> footprints_glb;     ///< objects that the tiles show as a flat plan
  std::set<std::string> solid_bodies_gml;   ///< Building or BuildingPart with a solid
  std::size_t glb_rows = 0;
  std::vector<std::string> errors;          ///< unreadable files, wrong coordinates
};

/// The object that a body belongs to: the last OSM id in "w1", "w1.2", "w1.rest", "w1.w2", "w1.w2.3".
std::string owner(const std::string& id) {
  std::string last;
  for (std::size_t start = 0; start < id.size();) {
    const std::size_t end = std::min(id.find('.', start), id.size());
    const char type = id[start];
    if ((type == 'n' || type == 'w' || type == 'r') && end > start + 1 &&
        id.find_first_not_of("-0123456789", start + 1) >= end)
      last = id.substr(start, end - start);
    start = end + 1;
  }
  return last.empty() ? id : last;
}

template <class Judge>
std::string said_by(const Judge& judge) {
  try {
    return judge();
  } catch (const std::exception& error) {
    return std::string("the judge gave up: ") + error.what();
  }
}

void note(Findings& out, const std::string& kind, const std::string& what, const std::string& own, const std::string& cgal) {
  Tally& tally = out.by_kind[kind];
  ++tally.checked;
  tally.invalid_own += !own.empty();
  tally.invalid_cgal += !cgal.empty();
  if (own.empty() && cgal.empty()) return;
  const std::string line = fmt::format("{} {}: own: {}; CGAL: {}", kind, what, own.empty() ? "valid" : own, cgal.empty() ? "valid" : cgal);
  tally.invalid.push_back(line);
  if (own.empty() == cgal.empty()) return;
  ++tally.disagreements;
  tally.disagreeing.push_back(line);
}

// ---- CityGML --------------------------------------------------------------------------------------------------------

/// Back on the 1/1024 m grid that four decimals were written from, with equal points as one vertex.
/// \param off  largest distance of a coordinate from the grid, m
model::Solid solid_on_grid(const validators::GmlSolid& read, double& off) {
  model::Solid solid;
  std::map<Point3, std::uint32_t> index;
  for (const validators::GmlPolygon& polygon : read.polygons) {
    model::Face face;
    face.first_loop = static_cast<std::uint32_t>(solid.loops.size());
    face.loop_count = static_cast<std::uint32_t>(polygon.rings.size());
    for (const auto& ring : polygon.rings) {
      solid.loops.push_back({static_cast<std::uint32_t>(solid.indices.size()), static_cast<std::uint32_t>(ring.size())});
      for (const Point3& p : ring) {
        const Point3 q = model::snap(p);
        off = std::max({off, std::fabs(q.x - p.x), std::fabs(q.y - p.y), std::fabs(q.z - p.z)});
        const auto [place, is_new] = index.emplace(q, static_cast<std::uint32_t>(solid.vertices.size()));
        if (is_new) solid.vertices.push_back(q);
        solid.indices.push_back(place->second);
      }
    }
    solid.faces.push_back(face);
  }
  return solid;
}

std::string own_verdict(const validators::GmlSolid& read, double& off) {
  const model::Solid solid = solid_on_grid(read, off);
  const auto triangles = geometry::triangulate(solid);
  if (!triangles) return "a face is no simple polygon";
  const geometry::SolidCheck check = geometry::check_solid(solid, *triangles);
  return check.valid() ? "" : check.text();
}

std::string cgal_verdict(const validators::GmlSolid& read) {
  std::vector<geometry::PolygonRings> polygons;
  for (const validators::GmlPolygon& p : read.polygons) polygons.push_back(p.rings);
  return geometry::judge_solid(polygons);
}

bool inside_envelope(const validators::GmlFile& file, const validators::GmlSolid& solid) {
  if (!file.lower || !file.upper) return false;
  const Point3 a = *file.lower, b = *file.upper;
  for (const auto& polygon : solid.polygons)
    for (const auto& ring : polygon.rings)
      for (const Point3& p : ring)
        if (p.x < a.x || p.y < a.y || p.z < a.z || p.x > b.x || p.y > b.y || p.z > b.z) return false;
  return true;
}

void judge_citygml(const fs::path& path, const std::string& name, Findings& out) {
  const validators::GmlFile file = validators::read_citygml(path.string());
  for (const validators::GmlBuilding& b : file.buildings)
    if (!b.part) out.buildings.insert(b.id);
  for (const validators::GmlSolid& solid : file.solids) {
    double off = 0;
    const std::string own = said_by([&] { return own_verdict(solid, off); });
    const std::string cgal = said_by([&] { return cgal_verdict(solid); });
    note(out, fmt::format("CityGML LoD{}", solid.lod), name + " " + solid.building, own, cgal);
    out.modelled_gml.insert(owner(solid.building));
    out.solid_bodies_gml.insert(solid.building);
    // Four decimals of a multiple of 1/1024 m are off by half a unit of the last one at most.
    if (off > 0.5001e-4) out.errors.push_back(fmt::format("{} {}: a coordinate lies {:.6f} m off the 1/1024 m grid", name, solid.building, off));
    if (!inside_envelope(file, solid)) out.errors.push_back(name + " " + solid.building + ": a point lies outside of gml:Envelope");
  }
}

// ---- GLB ------------------------------------------------------------------------------------------------------------

std::string own_verdict(const validators::GlbFeature& feature) {
  constexpr double kSteps = 65536;
  const Point3 o = feature.triangles.front().corners[0];
  std::vector<geometry::Grid3> vertices;
  std::map<Point3, std::uint32_t> index;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const validators::GlbTriangle& t : feature.triangles) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Point3& p = t.corners[k];
      const auto [place, is_new] = index.emplace(p, static_cast<std::uint32_t>(vertices.size()));
      if (is_new)
        vertices.push_back({std::llrint((p.x - o.x) * kSteps), std::llrint((p.y - o.y) * kSteps), std::llrint((p.z - o.z) * kSteps)});
      corners[k] = place->second;
    }
    triangles.push_back(corners);
  }
  const geometry::SolidCheck check = geometry::check_mesh(vertices, triangles);
  return check.valid() ? "" : check.text();
}

std::string cgal_verdict(const validators::GlbFeature& feature) {
  std::vector<std::vector<Point3>> triangles;
  for (const validators::GlbTriangle& t : feature.triangles) triangles.emplace_back(t.corners.begin(), t.corners.end());
  return geometry::judge_triangles(triangles);
}

void judge_glb(const fs::path& path, const std::string& name, bool tile, Findings& out) {
  const validators::GlbFile file = validators::read_glb(path.string());
  if (tile) out.glb_rows += file.features.size();
  for (const validators::GlbFeature& feature : file.features) {
    if (feature.triangles.empty()) continue;  // a part without a solid has its row all the same
    const auto lod = feature.numbers.find("lod");
    if (lod == feature.numbers.end() || lod->second < 1) {
      if (tile) out.footprints_glb.insert(owner(feature.id));  // a plan laid on the ground, not a solid
      continue;
    }
    const std::string own = said_by([&] { return own_verdict(feature); });
    const std::string cgal = said_by([&] { return cgal_verdict(feature); });
    note(out, tile ? "GLB tiles" : "model.glb", name + " " + feature.id, own, cgal);
    if (tile) out.modelled_glb.insert(owner(feature.id));
  }
}

// ---- the build ------------------------------------------------------------------------------------------------------

struct File {
  fs::path path;
  std::string name;  ///< relative to the build
  enum { citygml, glb_tile, single_glb } kind;
};

std::vector<File> files_of(const fs::path& folder) {
  std::vector<File> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const std::string name = fs::relative(entry.path(), folder).generic_string();
    if (name.ends_with(".gml") || name.ends_with(".gml.gz"))
      files.push_back({entry.path(), name, File::citygml});
    else if (name.ends_with(".glb"))
      files.push_back({entry.path(), name, name == "model.glb" ? File::single_glb : File::glb_tile});
  }
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.name < b.name; });
  return files;
}

void merge(Findings& sum, Findings&& one) {
  for (auto& [kind, t] : one.by_kind) {
    Tally& s = sum.by_kind[kind];
    s.checked += t.checked;
    s.invalid_own += t.invalid_own;
    s.invalid_cgal += t.invalid_cgal;
    s.disagreements += t.disagreements;
    std::move(t.invalid.begin(), t.invalid.end(), std::back_inserter(s.invalid));
    std::move(t.disagreeing.begin(), t.disagreeing.end(), std::back_inserter(s.disagreeing));
  }
  // A body stands in one file only: the same id twice would be one solid too few in the set.
  const auto unite = [&](std::set<std::string>& to, std::set<std::string>& from, const char* what) {
    for (const std::string& id : from)
      if (!to.insert(id).second) sum.errors.push_back(fmt::format("{}: {} stands in two files", what, id));
  };
  unite(sum.buildings, one.buildings, "CityGML");
  unite(sum.solid_bodies_gml, one.solid_bodies_gml, "CityGML");
  sum.modelled_gml.merge(one.modelled_gml);
  sum.modelled_glb.merge(one.modelled_glb);
  sum.footprints_glb.merge(one.footprints_glb);
  sum.glb_rows += one.glb_rows;
  std::move(one.errors.begin(), one.errors.end(), std::back_inserter(sum.errors));
}

Findings judge(const std::vector<File>& files) {
  std::vector<Findings> each(files.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < files.size(); i = next++) {
      const File& f = files[i];
      try {
        if (f.kind == File::citygml)
          judge_citygml(f.path, f.name, each[i]);
        else
          judge_glb(f.path, f.name, f.kind == File::glb_tile, each[i]);
      } catch (const std::exception& error) {
        each[i].errors.push_back(f.name + ": unreadable: " + error.what());
      }
    }
  };
  std::thread second(work);
  work();
  second.join();
  Findings sum;
  for (Findings& one : each) merge(sum, std::move(one));
  return sum;
}

/// Every count of build.json that the files can confirm.
void compare_counts(const nlohmann::json& build, Findings& f) {
  const auto& counts = build.at("counts");
  const auto& configuration = build.at("configuration");
  const int lod = configuration.at("lod");
  const auto formats = configuration.at("formats").get<std::set<std::string>>();
  const auto count = [&](const char* key) { return counts.at(key).get<std::size_t>(); };
  const auto expect = [&](const std::string& what, std::size_t is, const char* key) {
    if (is != count(key)) f.errors.push_back(fmt::format("{}: {} in the files, {} {} in build.json", what, is, count(key), key));
  };
  const std::size_t best = std::max(count("solids_lod1"), count("solids_lod2"));
  if (formats.count("citygml")) {
    expect("CityGML LoD1 solids", f.by_kind["CityGML LoD1"].checked, "solids_lod1");
    expect("CityGML LoD2 solids", f.by_kind["CityGML LoD2"].checked, "solids_lod2");
    if (lod >= 1) expect("objects with a solid in CityGML", f.modelled_gml.size(), "models");
  }
  if (formats.count("gltf") && lod >= 1) {
    expect("objects with a mesh in the tiles", f.modelled_glb.size(), "models");
    if (f.by_kind["GLB tiles"].checked < best)
      f.errors.push_back(fmt::format("{} features with a mesh in the tiles, {} solids in build.json", f.by_kind["GLB tiles"].checked, best));
    if (formats.count("citygml") && f.solid_bodies_gml.size() != f.by_kind["GLB tiles"].checked)
      f.errors.push_back(fmt::format("{} bodies with a solid in CityGML, {} with a mesh in the tiles", f.solid_bodies_gml.size(), f.by_kind["GLB tiles"].checked));
  }
  if (formats.count("gltf") && lod == 0) expect("objects with a plan in the tiles", f.footprints_glb.size(), "models");
  if (configuration.at("single_glb").get<bool>() && lod >= 1 && formats.count("gltf") &&
      f.by_kind["model.glb"].checked != f.by_kind["GLB tiles"].checked)
    f.errors.push_back(fmt::format("{} features with a mesh in model.glb, {} in the tiles", f.by_kind["model.glb"].checked, f.by_kind["GLB tiles"].checked));
}

void print_some(const std::vector<std::string>& lines) {
  for (std::size_t i = 0; i < std::min(lines.size(), kShown); ++i) fmt::print("  {}\n", lines[i]);
  if (lines.size() > kShown) fmt::print("  … and {} more\n", lines.size() - kShown);
}

int run(const fs::path& folder, std::size_t sample) {
  const nlohmann::json build = nlohmann::json::parse(std::ifstream(folder / "build.json"));
  std::vector<File> files = files_of(folder);
  if (sample > 1) {
    std::vector<File> some;
    for (std::size_t i = 0; i < files.size(); i += sample) some.push_back(files[i]);
    files = std::move(some);
  }
  Findings f = judge(files);
  if (sample <= 1) compare_counts(build, f);

  std::size_t solids = 0, invalid = 0, disagreements = 0;
  fmt::print("{:<14} {:>9} {:>13} {:>13} {:>10}\n", "solids of", "checked", "invalid: own", "invalid: CGAL", "disagree");
  for (const auto& [kind, t] : f.by_kind) {
    if (t.checked == 0) continue;
    fmt::print("{:<14} {:>9} {:>13} {:>13} {:>10}\n", kind, t.checked, t.invalid_own, t.invalid_cgal, t.disagreements);
    solids += t.checked;
    invalid += t.invalid.size();
    disagreements += t.disagreements;
  }
  for (const auto& [kind, t] : f.by_kind) {
    if (!t.invalid.empty()) fmt::print("invalid:\n"), print_some(t.invalid);
    if (!t.disagreeing.empty()) fmt::print("the judges disagree:\n"), print_some(t.disagreeing);
  }
  const std::size_t promised = build.at("counts").at("solids_lod1").get<std::size_t>() + build.at("counts").at("solids_lod2").get<std::size_t>();
  if (solids == 0 && promised > 0) f.errors.push_back(fmt::format("no solid found, build.json counts {}", promised));
  if (!f.errors.empty()) fmt::print("errors:\n"), print_some(f.errors);
  const bool clean = invalid == 0 && f.errors.empty();
  fmt::print("judge_build: {}: {} files, {} buildings, {} solids, {} invalid, {} disagreements, {} errors\n",
             clean ? "clean" : "NOT CLEAN", files.size(), f.buildings.size(), solids, invalid, disagreements, f.errors.size());
  return clean ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::string folder;
  std::size_t sample = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--sample" && i + 1 < argc)
      sample = static_cast<std::size_t>(std::max(1, std::atoi(argv[++i])));
    else if (folder.empty() && !argument.starts_with('-'))
      folder = argument;
    else
      folder.clear(), i = argc;
  }
  if (folder.empty() || !fs::exists(fs::path(folder) / "build.json")) {
    fmt::print(stderr, "usage: judge_build OUT_FOLDER [--sample N]   (a folder with build.json)\n");
    return 2;
  }
  xmlInitParser();
  try {
    return run(folder, sample);
  } catch (const std::exception& error) {
    fmt::print("judge_build: NOT CLEAN: {}\n", error.what());
    return 1;
  }
}
