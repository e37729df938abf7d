#include "pipeline/run/build_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "pipeline/base/assets.h"
#include "pipeline/base/attribution.h"
#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/template.h"
#include "pipeline/base/text.h"
#include "pipeline/outputs/area_folders.h"
#include "pipeline/outputs/gzip.h"
#include "pipeline/run/assets.h"
#include "pipeline/run/changes_map.h"

namespace blockrand::run {
namespace {

using base::Values;

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Rows of a table of the page, at most; the JSON has all.
constexpr std::size_t kMostRows = 500;

/// What a build says of one building, as far as it is compared.
struct Told {
  bool modelled = false, simpler = false;
  double area = 0;  ///< m2
  std::string ring;
  std::optional<double> height;
  struct Attribute {
    std::string name, value, source, why;
  };
  std::vector<Attribute> attributes;
};

std::string text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_null() ? std::string() : value.dump();
}

std::string member(const Json& j, const char* key) { return j.is_object() && j.contains(key) ? text_of(j[key]) : ""; }

Told told_of(const Json& line, int asked) {
  Told told;
  told.modelled = member(line, "state") == "modelled";
  const bool parts = line.contains("lod") && line["lod"].is_number_integer();
  told.simpler = told.modelled ? parts && line["lod"].get<int>() < asked : member(line, "state") == "reported";
  if (line.contains("outline")) told.ring = line["outline"].dump();
  if (line.contains("repair") && line["repair"].is_object() && line["repair"].contains("area") &&
      line["repair"]["area"].is_number())
    told.area = line["repair"]["area"].get<double>();
  if (line.contains("attributes") && line["attributes"].is_array())
    for (const Json& a : line["attributes"]) {
      told.attributes.push_back({member(a, "name"), member(a, "value"), member(a, "source"), member(a, "why")});
      if (told.attributes.back().name == "height" && a.contains("value") && a["value"].is_number())
        told.height = a["value"].get<double>();
    }
  return told;
}

using ToldById = std::map<std::string, Told>;

/// What a tile counts for where both builds have it alike.
struct TileSums {
  std::uint64_t all = 0, modelled = 0, simpler = 0, with_height = 0;
  double heights = 0;  ///< m
};

/// Takes from a line of explanations what TileSums count. Most of a line is why things are as they are: what stands before the tags is
/// read, and the attributes up to the height.
class LineCounter : public nlohmann::json_sax<Json> {
 public:
  explicit LineCounter(int asked) : asked_(asked) {}

  /// \param modelled  gets the id, where there is a model of it; may be null \returns  false where the line is none
  bool count(std::string_view line, TileSums& sums, std::vector<std::string>* modelled) {
    id_.clear(), state_.clear(), lod_.reset(), height_.reset();
    // Either they are at its end, or the reading ends where no more is wanted.
    if (!read(line, false) || id_.empty()) return false;
    // In a text the quotes would stand behind a backslash, and what a key of OSM has is a text.
    constexpr std::string_view kAttributes = "\"attributes\":[";
    if (const std::size_t at = line.find(kAttributes);
        at != std::string_view::npos && !read(line.substr(at + kAttributes.size() - 1), true))
      return false;
    ++sums.all;
    if (state_ == "modelled") {
      ++sums.modelled;
      sums.simpler += lod_ && *lod_ < asked_;
      if (height_) ++sums.with_height, sums.heights += *height_;
      if (modelled) modelled->push_back(id_);
    } else {
      sums.simpler += state_ == "reported";
    }
    return true;
  }

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t value) override { return integer(value); }
  bool number_unsigned(number_unsigned_t value) override { return integer(static_cast<std::int64_t>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool string(string_t& text) override {
    if (in_head() && key_ == "id") id_ = text;
    if (in_head() && key_ == "state") state_ = text;
    if (attributes_ && depth_ == 2 && key_ == "name") name_ = text;
    return true;
  }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override {
    ++depth_;
    if (attributes_ && depth_ == 2) name_.clear(), value_.reset();
    return true;
  }
  bool key(string_t& text) override {
    key_ = text;
    done_ = done_ || (in_head() && text == "tags");
    return !done_;
  }
  bool end_object() override {
    if (attributes_ && depth_ == 2 && name_ == "height" && value_) height_ = value_, done_ = true;
    --depth_;
    return !done_;
  }
  bool start_array(std::size_t) override { return ++depth_, true; }
  bool end_array() override {
    done_ = done_ || --depth_ == 0;
    return !done_;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 private:
  /// \param attributes  whether it is their list, else the line
  bool read(std::string_view text, bool attributes) {
    attributes_ = attributes, depth_ = 0, done_ = false, key_.clear(), name_.clear(), value_.reset();
    return Json::sax_parse(text.begin(), text.end(), this) || done_;
  }
  bool in_head() const { return !attributes_ && depth_ == 1; }
  bool integer(std::int64_t value) {
    if (in_head() && key_ == "lod") lod_ = value;
    return number(static_cast<double>(value));
  }
  bool number(double value) {
    if (attributes_ && depth_ == 2 && key_ == "value") value_ = value;
    return true;
  }

  int asked_, depth_ = 0;
  bool attributes_ = false, done_ = false;
  std::string key_, id_, state_, name_;
  std::optional<std::int64_t> lod_;
  std::optional<double> value_, height_;
};

/// The explanations of a build, tile by tile; of one in areas, those of some of its areas.
class Explained {
 public:
  /// \param but_for  areas that are left out
  /// \throws base::InputError  no build, or one without explanations
  explicit Explained(std::string folder, const std::set<std::string>& but_for = {}) : folder_(std::move(folder)) {
    const Json record = add_part("");
    asked_ = record["configuration"]["lod"].get<int>();
    for (const std::string& area : outputs::area_folders(folder_))
      if (!but_for.contains(area)) add_part(area + "/");
  }
  /// Hashes by path, as build.json has them.
  const std::map<std::string, std::string>& files() const { return files_; }
  /// By name, with the part of the build that they lie in.
  const std::map<std::string, std::string>& tiles() const { return tiles_; }

  int asked() const { return asked_; }

  /// Of a tile's file, as build.json has it; empty where it does not say.
  std::string hash(const std::string& tile) const {
    const auto place = tiles_.find(tile);
    const auto found = place == tiles_.end() ? files_.end() : files_.find(place->second + "explain/" + tile);
    return found == files_.end() ? std::string() : found->second;
  }

  /// Empty for a tile that it has not. \throws base::InputError  the file is damaged
  ToldById read(const std::string& tile) const {
    ToldById out;
    for_each_line(tile, [&](const char* first, const char* last) {
      const Json line = Json::parse(first, last, nullptr, false);
      if (line.is_object()) out.emplace(member(line, "id"), told_of(line, asked_));
      return line.is_object();
    });
    return out;
  }

  /// What read() would count. \param modelled  gets the ids of what has a model; may be null \throws as read
  TileSums sums(const std::string& tile, std::vector<std::string>* modelled = nullptr) const {
    TileSums sums;
    LineCounter counter(asked_);
    for_each_line(tile, [&](const char* first, const char* last) {
      return counter.count(std::string_view(first, static_cast<std::size_t>(last - first)), sums, modelled);
    });
    return sums;
  }

 private:
  /// \param visit  returns whether the line is one of JSON
  template <class Visit>
  void for_each_line(const std::string& tile, Visit&& visit) const {
    const auto place = tiles_.find(tile);
    if (place == tiles_.end()) return;
    const std::string path = folder_ + "/" + place->second + "explain/" + tile;
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const auto damaged = [&](const std::string& why) {
      return base::InputError(path, "", why, "The build is damaged: build it again, or roll back");
    };
    std::string text;
    try {
      text = outputs::gunzip(bytes);
    } catch (const std::runtime_error& failed) {
      throw damaged(failed.what());
    }
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      if (!visit(text.data() + at, text.data() + end)) throw damaged("a line of it is no JSON");
      at = end + 1;
    }
  }

  Json add_part(const std::string& part) {
    const std::string folder = folder_ + "/" + part;
    std::ifstream record_file(folder + "build.json", std::ios::binary);
    Json record = Json::parse(record_file, nullptr, false);
    if (!record.is_object() || !record.contains("configuration") || !record["configuration"].contains("lod"))
      throw base::InputError(folder + "build.json", "", "is no record of a build", "Put the build back, or roll back");
    std::error_code error;
    const bool empty = record.contains("counts") && record["counts"].value("models", 0) == 0;
    if (!fs::is_directory(folder + "explain", error) && !empty && !record.contains("areas"))
      throw base::InputError(folder_, "", "was built without explanations, which builds are compared by",
                             "Take explain = false out of region.toml");
    for (fs::directory_iterator entry(folder + "explain", error), end; !error && entry != end; entry.increment(error))
      if (const std::string name = entry->path().filename().string(); name.ends_with(".jsonl.gz")) tiles_[name] = part;
    if (record.contains("files") && record["files"].is_object())
      for (const auto& [path, file] : record["files"].items()) files_[part + path] = member(file, "sha256");
    return record;
  }

  std::string folder_;
  int asked_ = 0;  ///< level of detail
  std::map<std::string, std::string> tiles_;
  std::map<std::string, std::string> files_;
};

void compare(const std::string& id, const Told& before, const Told& after, BuildChanges& out) {
  if (before.ring != after.ring || std::fabs(before.area - after.area) >= 0.01)
    out.outlines.push_back({id, before.area, after.area});
  std::map<std::string, const Told::Attribute*> old;
  for (const Told::Attribute& a : before.attributes) old[a.name] = &a;
  for (const Told::Attribute& a : after.attributes) {
    const auto found = old.find(a.name);
    const Told::Attribute* was = found == old.end() ? nullptr : found->second;
    if (found != old.end()) old.erase(found);
    if (!was || was->value != a.value || was->source != a.source)
      out.attributes.push_back({id, a.name, was ? was->value : "", a.value, was ? was->source : "", a.source, a.why});
  }
  for (const Told::Attribute& a : before.attributes)
    if (old.contains(a.name)) out.attributes.push_back({id, a.name, a.value, "", a.source, "", ""});
}

/// Of the tiles of an area, by the hash of what is told of them: the next night finds here what it has alike, without reading it.
using AreaSums = std::map<std::string, TileSums>;

/// The areas of a build, by their folder, with the hash of their records.
std::map<std::string, std::string> areas_of(const std::string& build) {
  std::map<std::string, std::string> areas;
  if (build.empty()) return areas;
  std::ifstream file(build + "/build.json", std::ios::binary);
  const Json record = Json::parse(file, nullptr, false);
  if (!record.is_object() || !record.contains("areas") || !record["areas"].is_object()) return areas;
  for (const auto& [name, area] : record["areas"].items()) areas["areas/" + name] = member(area, "build_sha256");
  return areas;
}

TileSums sums_of(const ToldById& tile) {
  TileSums sums;
  sums.all = tile.size();
  for (const auto& [id, told] : tile) {
    sums.modelled += told.modelled, sums.simpler += told.simpler;
    if (!told.modelled || !told.height) continue;
    ++sums.with_height;
    sums.heights += *told.height;
  }
  return sums;
}

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : part > 0 ? 100 : 0; }

std::string rounded(const std::string& value) {
  // Long fractions are for machines.
  const std::size_t point = value.find('.');
  return point != std::string::npos && value.size() - point > 3 &&
                 value.find_first_not_of("0123456789.-") == std::string::npos
             ? value.substr(0, point + 3)
             : value;
}

}  // namespace

BuildChanges compare_builds(const std::string& before, const std::string& after, const base::Memo* memo) {
  BuildChanges out;
  const std::map<std::string, std::string> areas_before = areas_of(before);
  std::map<std::string, std::string> alike;
  std::set<std::string> but_for;
  for (const auto& [area, hash] : areas_of(after))
    if (const auto was = areas_before.find(area); was != areas_before.end() && was->second == hash) {
      alike.emplace(area, hash);
      but_for.insert(area);
    }
  const std::optional<Explained> old =
      before.empty() ? std::nullopt : std::optional<Explained>(std::in_place, before, but_for);
  const Explained now(after, but_for);
  std::set<std::string> tiles;
  for (const auto& [tile, part] : now.tiles()) tiles.insert(tile);
  if (old)
    for (const auto& [tile, part] : old->tiles()) tiles.insert(tile);
  double heights_before = 0, heights_after = 0;
  const auto add_alike = [&](const TileSums& sums) {
    out.all_before += sums.all, out.all_after += sums.all;
    out.before += sums.modelled, out.after += sums.modelled;
    out.simpler_before += sums.simpler, out.simpler_after += sums.simpler;
    heights_before += sums.heights, heights_after += sums.heights;
    out.both += sums.with_height;
  };
  const auto remembered_area = [&](const std::string& record, const std::function<AreaSums()>& work) {
    return base::remembered<AreaSums>(
        memo, "told", [&](base::Packer& packer) { packer << std::string("area") << record; }, work);
  };
  const auto sums_of_area = [&](const std::string& build, const std::string& area, const std::string& record) {
    return remembered_area(record, [&] {
      const Explained its(build + "/" + area);
      AreaSums all;
      for (const auto& [tile, part] : its.tiles()) {
        const std::string hash = its.hash(tile);
        all.emplace(hash.empty() ? tile : hash, its.sums(tile));
      }
      return all;
    });
  };
  for (const auto& [area, hash] : alike)
    for (const auto& [tile, sums] : sums_of_area(after, area, hash)) add_alike(sums);
  AreaSums known;  // of the areas that differ, as they were
  if (old && memo && old->asked() == now.asked())
    for (const auto& [area, hash] : areas_before)
      if (!alike.contains(area)) try {
          known.merge(sums_of_area(before, area, hash));
        } catch (const base::InputError&) {
          // Its tiles are read one by one: what is damaged may be of no interest.
        }
  std::map<std::string, AreaSums> of_parts;  // the same as they are, for the next night
  const auto meet = [&](const std::string& id, const Told& was, const Told& is) {
    if (!was.modelled || !is.modelled) {
      if (was.modelled) out.removed.push_back(id), out.footprints[id] = was.ring;
      if (is.modelled) out.added.push_back(id), out.footprints[id] = is.ring;
      return;
    }
    const std::size_t differences = out.outlines.size() + out.attributes.size();
    compare(id, was, is, out);
    if (out.outlines.size() + out.attributes.size() > differences) out.footprints[id] = is.ring;
    if (!is.height || !was.height) return;
    heights_before += *was.height, heights_after += *is.height;
    ++out.both;
  };
  // A tile of both at a time. What only one of them has there may lie in another tile of the other one: it was moved.
  ToldById gone, come;
  for (const std::string& tile : tiles) {
    const std::string hash = now.hash(tile);
    const auto place = now.tiles().find(tile);
    AreaSums* const area = place == now.tiles().end() || place->second.empty() ? nullptr : &of_parts[place->second];
    ToldById its;
    bool read = false;
    const auto remembered_sums = [&](const std::function<TileSums()>& work) {
      return base::remembered<TileSums>(
          hash.empty() || area ? nullptr : memo, "told", [&](base::Packer& packer) { packer << hash << now.asked(); },
          work);
    };
    const auto sums_now = [&] {
      if (const auto found = known.find(hash); !hash.empty() && found != known.end()) return found->second;
      return remembered_sums([&] { return read ? sums_of(its) : now.sums(tile); });
    };
    if (old && !hash.empty() && old->hash(tile) == hash && old->asked() == now.asked()) {
      const TileSums sums = sums_now();
      add_alike(sums);
      if (area) area->emplace(hash, sums);
      continue;
    }
    if (!old) {
      std::vector<std::string> modelled;
      const TileSums sums = now.sums(tile, &modelled);
      remembered_sums([&] { return sums; });
      if (area) area->emplace(hash.empty() ? tile : hash, sums);
      out.all_after += sums.all, out.after += sums.modelled, out.simpler_after += sums.simpler;
      std::ranges::move(modelled, std::back_inserter(out.added));
      continue;
    }
    its = now.read(tile), read = true;
    const TileSums sums = sums_now();  // for the next night
    if (area) area->emplace(hash.empty() ? tile : hash, sums);
    ToldById mine = old->read(tile);
    out.all_before += mine.size(), out.all_after += its.size();
    for (const auto& [id, told] : mine) out.before += told.modelled, out.simpler_before += told.simpler;
    for (auto& [id, told] : its) {
      out.after += told.modelled, out.simpler_after += told.simpler;
      const auto found = mine.find(id);
      if (found == mine.end()) {
        come.emplace(id, std::move(told));
        continue;
      }
      meet(id, found->second, told);
      mine.erase(found);
    }
    gone.merge(mine);
    for (auto at = come.begin(); at != come.end();) {
      const auto found = gone.find(at->first);
      if (found == gone.end()) {
        ++at;
        continue;
      } else {
        meet(at->first, found->second, at->second);
        gone.erase(found);
      }
      at = come.erase(at);
    }
  }
  for (const auto& [part, sums] : of_parts)
    remembered_area(base::sha256_file(after + "/" + part + "build.json"), [&its = sums] { return its; });
  for (const auto& [id, told] : gone)
    if (told.modelled) out.removed.push_back(id), out.footprints[id] = told.ring;
  for (const auto& [id, told] : come)
    if (told.modelled) out.added.push_back(id), out.footprints[id] = told.ring;
  if (old) {
    for (const auto& [path, hash] : now.files())
      if (const auto found = old->files().find(path); found == old->files().end() || found->second != hash)
        out.files_changed.push_back(path);
    for (const auto& [path, hash] : old->files())
      if (!now.files().contains(path)) out.files_removed.push_back(path);
  }
  std::ranges::sort(out.added), std::ranges::sort(out.removed);
  std::ranges::sort(out.outlines, {}, &OutlineChange::id);
  std::ranges::stable_sort(out.attributes, {}, &AttributeChange::id);
  if (out.both > 0)
    out.height_before = heights_before / static_cast<double>(out.both),
    out.height_after = heights_after / static_cast<double>(out.both);
  return out;
}

std::vector<Gate> drift_gates(const BuildChanges& c, const RegionOptions& o) {
  RegionOptions drift = o;
  drift.max_lost = drift.max_added = drift.max_simpler = drift.max_height_change = o.max_drift;
  std::vector<Gate> gates = gates_of(c, drift, false);
  std::erase_if(gates, [](const Gate& g) { return g.key == "no_buildings"; });
  for (Gate& g : gates) g.key = "max_drift", g.words += fmt::format(", against build {}", o.baseline);
  return gates;
}

std::vector<Gate> gates_of(const BuildChanges& c, const RegionOptions& o, bool first) {
  const auto n = [](auto count) { return static_cast<double>(count); };
  std::vector<Gate> gates;
  gates.push_back({"no_buildings", "builds without any building", c.after == 0 ? 1.0 : 0.0, 0});
  if (first) return gates;
  gates.push_back({"max_lost", "buildings that are gone", percent(n(c.removed.size()), n(c.before)), o.max_lost});
  gates.push_back({"max_added", "buildings that are new", percent(n(c.added.size()), n(c.before)), o.max_added});
  gates.push_back({"max_simpler", "more buildings that are simpler than asked, or have no model",
                   percent(n(c.simpler_after), n(c.all_after)) - percent(n(c.simpler_before), n(c.all_before)),
                   o.max_simpler});
  gates.push_back({"max_height_change", "change of the mean height",
                   percent(std::fabs(c.height_after - c.height_before), c.height_before), o.max_height_change});
  return gates;
}

std::string changes_json(const BuildChanges& c, const std::vector<Gate>& gates) {
  const auto hundredths = [](double v) { return std::round(v * 100) / 100; };
  Json j;
  j["attribution"] = base::kAttribution;
  j["buildings"] = {{"before", c.before}, {"after", c.after}, {"added", c.added.size()}, {"removed", c.removed.size()}};
  j["gates"] = Json::array();
  for (const Gate& g : gates)
    j["gates"].push_back({{"gate", g.key},
                          {"what", g.words},
                          {"value", hundredths(g.value)},
                          {"limit", g.limit},
                          {"exceeded", g.exceeded()}});
  if (!c.settings_before.empty() || !c.settings_after.empty())
    j["settings"] = {{"removed", c.settings_before}, {"added", c.settings_after}};
  j["added"] = c.added, j["removed"] = c.removed;
  j["files"] = {{"changed", c.files_changed}, {"removed", c.files_removed}};
  j["outlines"] = Json::array();
  for (const OutlineChange& o : c.outlines)
    j["outlines"].push_back(
        {{"id", o.id}, {"area_before_m2", hundredths(o.area_before)}, {"area_after_m2", hundredths(o.area_after)}});
  j["attributes"] = Json::array();
  for (const AttributeChange& a : c.attributes)
    j["attributes"].push_back({{"id", a.id},
                               {"attribute", a.name},
                               {"from", a.from},
                               {"to", a.to},
                               {"from_source", a.from_source},
                               {"to_source", a.to_source},
                               {"why", a.why}});
  return j.dump(1) + "\n";
}

std::string changes_page(const std::string& title, const BuildChanges& c, const std::vector<Gate>& gates) {
  Values page;
  page.set("title", title).set("page_css", base::asset("page.css"));
  page.set("attribution", base::kAttribution);
  page.set("before", base::with_thousands(c.before)).set("after", base::with_thousands(c.after));
  page.set("added", base::with_thousands(c.added.size())).set("removed", base::with_thousands(c.removed.size()));
  page.set("outlines", base::with_thousands(c.outlines.size()))
      .set("values", base::with_thousands(c.attributes.size()));
  if (std::optional<Values> map = changes_map(c)) page.add("map", std::move(*map));
  const auto table = [&](const std::string& heading, const std::vector<std::string>& columns,
                         const std::vector<std::vector<std::string>>& rows, std::size_t all) {
    if (rows.empty()) return;
    Values values;
    values.set("heading", heading);
    for (const std::string& column : columns) values.add("columns", Values().set("column", column));
    Values::List lines;
    for (const auto& row : rows) {
      Values::List cells;
      for (const std::string& cell : row) cells.push_back(Values().set("cell", cell));
      lines.push_back(Values().set("cells", std::move(cells)));
    }
    values.set("rows", std::move(lines));
    values.set("more", all > rows.size() ? base::with_thousands(all - rows.size()) : std::string());
    page.add("tables", std::move(values));
  };
  std::vector<std::vector<std::string>> rows;
  for (const Gate& g : gates)
    rows.push_back(
        {g.words, fmt::format("{:.2f}", g.value), fmt::format("{:g}", g.limit), g.exceeded() ? "too much" : "well"});
  table("Gates", {"what", "percent", "limit", "verdict"}, rows, rows.size());
  rows.clear();
  for (const std::string& line : c.settings_before) rows.push_back({line, ""});
  for (const std::string& line : c.settings_after) rows.push_back({"", line});
  table("region.toml", {"before", "now"}, rows, rows.size());
  const auto list = [&](const std::string& heading, const std::vector<std::string>& ids) {
    rows.clear();
    for (std::size_t i = 0; i < std::min(ids.size(), kMostRows); ++i) rows.push_back({ids[i]});
    table(heading, {"building"}, rows, ids.size());
  };
  list("New buildings", c.added);
  list("Buildings that are gone", c.removed);
  rows.clear();
  for (std::size_t i = 0; i < std::min(c.outlines.size(), kMostRows); ++i)
    rows.push_back({c.outlines[i].id, fmt::format("{:.1f}", c.outlines[i].area_before),
                    fmt::format("{:.1f}", c.outlines[i].area_after)});
  table("Footprints", {"building", "m² before", "m² now"}, rows, c.outlines.size());
  rows.clear();
  for (std::size_t i = 0; i < std::min(c.attributes.size(), kMostRows); ++i) {
    const AttributeChange& a = c.attributes[i];
    rows.push_back({a.id, a.name, rounded(a.from), rounded(a.to), a.from_source, a.to_source, a.why});
  }
  table("Values", {"building", "what", "from", "to", "source before", "source now", "why"}, rows, c.attributes.size());
  return base::filled(asset, "changes.html", std::move(page));
}

}  // namespace blockrand::run
