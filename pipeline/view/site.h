// A build as a web page: what stands under which path, for the local server and for an export alike.
//
//   index.html, viewer.js, viewer.css, LICENSES.txt   the page (viewer/)
//   view.json                 what is shown: name, level of detail, middle, where its files are
//   model/…                   files of the build
//   explained/<tile>.json     why its buildings look as they do, in plain words
//
// Of a region these two are model/000003/… and explained/000003/…: a page goes on with the build that it began with, whatever is
// published meanwhile.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/view/file_beneath.h"

namespace blockrand::view {

/// What a path leads to: bytes, or a file of the build.
struct Resource {
  std::string type;  ///< MIME
  std::string bytes;
  std::shared_ptr<const FileBeneath> file;  ///< null: `bytes`
};

/// Safe to share between threads.
class Site {
 public:
  /// \param folder  of a build, or of a region, whose published build is shown: that of the moment when view.json is asked for
  /// \param name    for people; empty: that of the folder
  /// \throws base::UsageError  it is no build, or one without 3D Tiles
  explicit Site(std::string folder, std::string name = {});

  /// The same for the build that is shown now, and no later one.
  Site pinned() const;

  /// \param path  relative, decoded, without query; "" is the page
  /// \returns nothing where there is no such thing
  std::optional<Resource> find(std::string_view path) const;

  /// Every path of the site but those of model/ that no page asks for; each once.
  std::vector<std::string> paths() const;

  /// view.json. \throws base::InputError  the build's record or its tileset is damaged
  std::string description() const;

 private:
  /// A build, and what stands before its paths.
  struct Shown {
    std::string root, prefix;
  };
  Shown shown() const;
  /// Takes the prefix off `path`. Nothing where it names no build of the region.
  std::optional<std::string> root_of(std::string_view& path) const;
  std::string folder_, name_;
};

}  // namespace blockrand::view
