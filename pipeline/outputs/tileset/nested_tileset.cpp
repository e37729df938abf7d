#include "pipeline/outputs/tileset/nested_tileset.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

namespace blockrand::outputs {
namespace {

using Json = nlohmann::ordered_json;
using model::TileId;

/// A tile with what is below it.
struct Node {
  RegionVolume volume{};
  double error = 0;
  std::size_t names = 1;  ///< tilesets that it names in this file
  Json json;
};

RegionVolume joined(const RegionVolume& a, const RegionVolume& b) {
  return {std::min(a[0], b[0]), std::min(a[1], b[1]), std::max(a[2], b[2]),
          std::max(a[3], b[3]), std::min(a[4], b[4]), std::max(a[5], b[5])};
}

Json tile_of(const RegionVolume& volume, double error) {
  return {{"boundingVolume", {{"region", volume}}}, {"geometricError", error}};
}

/// Of all contents below a tile, where its file is moved into a folder of folders.
void put_before_uris(Json& tile, const std::string& start) {
  if (tile.contains("content")) tile["content"]["uri"] = start + tile["content"]["uri"].get<std::string>();
  if (tile.contains("children"))
    for (Json& child : tile["children"]) put_before_uris(child, start);
}

class Tree {
 public:
  Tree(const Json& asset, std::size_t most) : asset_(asset), most_(most) {}

  std::map<std::string, std::string> write(const std::vector<NestedTileset>& tilesets) {
    std::map<int, std::map<TileId, Node>, std::greater<>> by_level;
    for (const NestedTileset& t : tilesets) {
      Json json = tile_of(t.volume, t.error);
      json["content"] = {{"uri", t.uri}};
      by_level[t.tile.level][t.tile] = {t.volume, t.error, 1, std::move(json)};
    }
    // From the finest one up; those of coarser levels come in at their own.
    int at = by_level.begin()->first;
    std::map<TileId, Node> level = std::move(by_level.begin()->second);
    by_level.erase(by_level.begin());
    while (at > 0 && (level.size() > 1 || !by_level.empty())) {
      level = parents_of(std::move(level), by_level.empty());
      --at;
      if (by_level.empty() || by_level.begin()->first != at) continue;
      level.merge(by_level.begin()->second);
      by_level.erase(by_level.begin());
    }
    std::vector<Node*> top;
    for (auto& [tile, node] : level) top.push_back(&node);
    // More than one: on both sides of the prime meridian. And the root names what it shows as a child.
    Node root = top.size() == 1 && top.front()->json.contains("children") ? std::move(*top.front()) : parent_of(top);
    root.json["refine"] = "ADD";
    put("tileset.json", 2 * root.error, std::move(root.json));
    return std::move(files_);
  }

 private:
  void put(const std::string& path, double error, Json root) {
    files_[path] = Json({{"asset", asset_}, {"geometricError", error}, {"root", std::move(root)}}).dump() + "\n";
  }

  static Node parent_of(const std::vector<Node*>& children) {
    Node node;
    node.volume = children.front()->volume, node.names = 0;
    Json list = Json::array();
    for (Node* child : children) {
      node.volume = joined(node.volume, child->volume);
      node.error = std::max(node.error, 2 * child->error);
      node.names += child->names;
      list.push_back(std::move(child->json));
    }
    node.json = tile_of(node.volume, node.error);
    node.json["children"] = std::move(list);
    return node;
  }

  /// \param last  nothing but these will come
  std::map<TileId, Node> parents_of(std::map<TileId, Node> below, bool last) {
    std::map<TileId, std::vector<Node*>> families;
    for (auto& [tile, node] : below) families[{tile.level - 1, tile.x / 2, tile.y / 2}].push_back(&node);
    std::map<TileId, Node> above;
    for (const auto& [tile, children] : families) {
      Node& node = above[tile] = children.size() == 1 ? std::move(*children.front()) : parent_of(children);
      if (node.names > most_ && (families.size() > 1 || !last)) move_out(tile, node);
    }
    return above;
  }

  /// Into a file of its own, which the node leads to from here on.
  void move_out(const TileId& tile, Node& node) {
    const std::string path = fmt::format("tilesets/{}/{}/{}.json", tile.level, tile.x, tile.y);
    put_before_uris(node.json, "../../../");
    node.json["refine"] = "ADD";
    put(path, node.error, std::move(node.json));
    node.names = 1;
    node.json = tile_of(node.volume, node.error);
    node.json["content"] = {{"uri", path}};
  }

  const Json& asset_;
  std::size_t most_;
  std::map<std::string, std::string> files_;
};

}  // namespace

std::map<std::string, std::string> nested_tilesets(const std::vector<NestedTileset>& tilesets, const Json& asset,
                                                   std::size_t most) {
  if (!tilesets.empty()) return Tree(asset, most).write(tilesets);
  Json root = {
      {"boundingVolume", {{"box", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}}}}, {"geometricError", 0}, {"refine", "ADD"}};
  return {{"tileset.json", Json({{"asset", asset}, {"geometricError", 0}, {"root", std::move(root)}}).dump() + "\n"}};
}

}  // namespace blockrand::outputs
