// Geometry as it is met in the file, before xlinks are resolved. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "importers/reference/note_log.h"
#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference {

/// The faces of the file in reading order, each a polygon or a link to something with an id. A geometry is a range of
/// them, and so is everything that a link may point to.
class Links {
 public:
  void add_polygon(std::uint32_t polygon, bool reversed) { items_.push_back({polygon, kNone, 0, reversed}); }
  void add_link(const std::string& target, bool reversed, int line);

  std::size_t size() const { return items_.size(); }

  /// Gives the items from `begin` on a name that links may use. The first of a name wins.
  /// \param reversed  the orientation in which the named thing itself was met
  void name(const std::string& id, std::size_t begin, bool reversed) {
    names_.emplace(id, Range{begin, items_.size(), reversed});
  }

  /// The faces of a range, links followed. What leads nowhere, in a circle or multiplies without end is noted and left
  /// out.
  std::vector<Face> resolve(std::size_t begin, std::size_t end, NoteLog& notes);

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  struct Item {
    std::uint32_t polygon, link;
    int line;
    bool reversed;
    bool open = false;  ///< a link that is being followed
  };
  struct Range {
    std::size_t begin, end;
    bool reversed;
  };
  /// A range that is being read.
  struct Step {
    std::size_t next, end;
    bool turn;
    std::size_t link;  ///< item that led here; items_.size(): none
  };
  std::size_t visits_ = 0;
  bool exhausted_ = false;
  std::vector<Item> items_;
  std::vector<std::string> targets_;
  std::unordered_map<std::string, Range> names_;  // looked up only
};

}  // namespace blockrand::importers::reference
