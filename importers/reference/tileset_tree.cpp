#include "importers/reference/tileset_tree.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "importers/reference/file_bytes.h"
#include "importers/reference/gltf_file.h"
#include "pipeline/base/error.h"

namespace blockrand::importers::reference {
namespace {

namespace fs = std::filesystem;

/// Contents that tiles name, and tilesets that are read, each time that they are met: two that are named twice at every
/// level double with each. The tilesets of whole states have less in one.
constexpr std::size_t kMostContents = 100'000, kMostTilesets = 10'000;

class Walker {
 public:
  Walker(Tileset& tileset, NoteLog& notes) : tileset_(tileset), notes_(notes) {}

  /// Whether some content was of a format of 3D Tiles 1.0.
  const std::string& old_format() const { return old_format_; }
  bool implicit() const { return implicit_; }
  /// How many contents tiles name, whether they can be read or not.
  std::size_t named() const { return named_; }

  void walk(const std::string& path, const Json& json, const Matrix4& parent) {
    constexpr std::size_t kDeepest = 32;
    open_files_.push_back(path);
    if (++walked_ > kMostTilesets) refuse_number(kMostTilesets, "tilesets");
    tileset_.bytes += size_on_disk(path);
    const std::string folder = fs::path(path).parent_path().string();
    const std::string axis = text(member(member(json, "asset"), "gltfUpAxis"));
    const Matrix4 up = axis == "Z" ? kIdentity : axis == "X" ? kXUpToZUp : kYUpToZUp;
    struct Open {
      const Json* tile;
      Matrix4 parent;
      bool replaces;  ///< what `refine` of the tile above said
    };
    std::vector<Open> open{{&member(json, "root"), parent, true}};
    while (!open.empty()) {
      const auto [tile, above, inherited] = open.back();
      open.pop_back();
      Matrix4 place = above;
      if (const Json& stated = member(*tile, "transform"); !stated.is_null()) {
        const auto matrix = matrix_of(stated);
        if (matrix) {
          place = above * *matrix;
        } else {
          notes_.add(NoteKind::bad_value, 0, path + ": a tile's transform is no matrix; the tile is left out");
          continue;
        }
      }
      const std::string refine = text(member(*tile, "refine"));
      const bool replaces = refine.empty() ? inherited : refine != "ADD" && refine != "add";
      const Json& children = member(*tile, "children");
      if (!member(*tile, "implicitTiling").is_null() ||
          !member(member(*tile, "extensions"), "3DTILES_implicit_tiling").is_null()) {
        notes_.add(NoteKind::not_read, 0, path + ": implicit tiling");
        implicit_ = true;
      } else if (length(children) == 0 || !replaces) {
        add_content(member(*tile, "content"), folder, place, up, kDeepest);
        for (const Json& content : member(*tile, "contents")) add_content(content, folder, place, up, kDeepest);
      }
      for (std::size_t i = length(children); i-- > 0;) open.push_back({&children[i], place, replaces});
    }
    open_files_.pop_back();
  }

 private:
  [[noreturn]] void refuse_number(std::size_t most, const std::string& what) const {
    throw base::InputError(
        open_files_.front(), "",
        "has more than " + std::to_string(most) + " " + what + ", each counted as often as it is met",
        "Tilesets that name others again and again multiply; or name a part of it");
  }

  void add_content(const Json& content, const std::string& folder, const Matrix4& place, const Matrix4& up,
                   std::size_t deepest) {
    if (!content.is_object()) return;
    if (++named_ > kMostContents) refuse_number(kMostContents, "contents");
    std::string uri = text(member(content, "uri"));
    if (uri.empty()) uri = text(member(content, "url"));  // as 0.0 had it
    const std::string file = file_of_uri(folder, uri);
    std::error_code error;
    if (uri.empty() || file.empty() || !fs::is_regular_file(file, error)) {
      notes_.add(NoteKind::unresolved_link, 0,
                 "content \"" + uri + "\" is " + (file.empty() ? "on the network" : "missing"));
      return;
    }
    const std::string head = first_bytes(file, 1U << 16);
    const std::string magic = head.substr(0, 4);
    if (magic == "b3dm" || magic == "i3dm" || magic == "cmpt" || magic == "pnts") {
      notes_.add(NoteKind::not_read, 0, "content " + file + " of format " + magic);
      old_format_ = magic;
      return;
    }
    if (magic == "glTF") {
      tileset_.contents.push_back({file, place * up});
      return;
    }
    Json json;
    try {
      json = parse_json(file, all_bytes(file));
    } catch (const base::InputError& broken) {
      notes_.add(NoteKind::malformed_json, 0, broken.what());
      return;
    }
    if (member(json, "root").is_null()) {
      tileset_.contents.push_back({file, place * up});  // glTF as text; its reader knows better where it is none
    } else if (open_files_.size() >= deepest ||
               std::find(open_files_.begin(), open_files_.end(), file) != open_files_.end()) {
      notes_.add(NoteKind::unresolved_link, 0, "tileset " + file + " holds itself");
    } else {
      walk(file, json, place);
    }
  }

  Tileset& tileset_;
  NoteLog& notes_;
  std::vector<std::string> open_files_;
  std::string old_format_;
  bool implicit_ = false;
  std::size_t named_ = 0, walked_ = 0;
};

}  // namespace

Tileset read_tileset(const std::string& path, const Json& json, NoteLog& notes) {
  Tileset out;
  const Json& asset = member(json, "asset");
  out.version = text(member(asset, "version"));
  out.crs = text(member(member(asset, "extras"), "crs"));
  out.height_words = text(member(member(asset, "extras"), "height_reference"));
  if (!member(json, "root").is_object()) throw base::InputError(path, "", "is no tileset: it has no root", "");
  Walker walker(out, notes);
  walker.walk(path, json, kIdentity);
  if (out.contents.empty() && !walker.old_format().empty())
    throw base::InputError(path, "", "its contents are " + walker.old_format() + ", which is not read",
                           "Convert it to 3D Tiles 1.1 with glTF contents, for instance: "
                           "npx 3d-tiles-tools upgrade -i IN -o OUT --targetVersion 1.1");
  if (out.contents.empty() && walker.implicit())
    throw base::InputError(path, "", "its tiles are implicit, which is not read",
                           "Name the GLB files, or a tileset that lists its tiles");
  if (out.contents.empty() && walker.named() > 0)
    throw base::InputError(path, "", "none of its contents can be read",
                           "They are missing, on the network or broken: put them where the tileset names them");
  return out;
}

}  // namespace blockrand::importers::reference
