// Collects notes while reading: a count and the first examples of each kind. Internal to this folder.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference {

class NoteLog {
 public:
  /// \param line  0: none
  void add(NoteKind kind, int line, std::string what) {
    constexpr std::size_t kExamples = 5, kLongest = 160;
    Note& note = notes_[kind];
    note.kind = kind;
    if (note.count++ >= kExamples) return;
    if (what.size() > kLongest) what = what.substr(0, kLongest) + "…";
    note.examples.push_back(line > 0 ? "line " + std::to_string(line) + ": " + std::move(what) : std::move(what));
  }

  std::vector<Note> take() {
    std::vector<Note> out;
    for (auto& [kind, note] : notes_) out.push_back(std::move(note));
    notes_.clear();
    return out;
  }

 private:
  std::map<NoteKind, Note> notes_;
};

}  // namespace blockrand::importers::reference
