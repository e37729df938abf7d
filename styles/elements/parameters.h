// Checked parameters of one element on their way to its generator. Internal to this folder.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "styles/elements/element_kind.h"
#include "styles/elements/mesh_builder.h"
#include "styles/elements/opening_edges.h"
#include "styles/elements/opening_shape.h"
#include "styles/elements/profile_library.h"

namespace blockrand::elements {

/// The values of all parameters of a kind, given or default, in range. Asking for a name that the kind does not have is
/// a programming error.
class Values {
 public:
  static tl::expected<Values, std::string> check(const ElementKind& kind, std::span<const Parameter> given,
                                                 const ProfileLibrary& profiles);

  double number(std::string_view name) const { return numbers_[index(name)]; }
  int count(std::string_view name) const { return static_cast<int>(number(name)); }
  const std::string& word(std::string_view name) const;
  bool is(std::string_view name, std::string_view word_) const { return word(name) == word_; }
  /// A moulding traced with as many pieces an arc as the detail asks for; lengths still to be scaled.
  Profile profile(std::string_view name) const;
  /// The shape of an opening's edge; empty for straight ones.
  std::optional<Profile> edge(std::string_view name) const;
  /// Any preset of the library, traced; empty when there is none of that name.
  Profile preset(std::string_view name) const;
  /// A program, traced the same way.
  Profile traced(const ProfileProgram& program) const;
  bool has(std::string_view name) const;
  /// The same, and it is a word: element files may have numbers of any name.
  bool has_word(std::string_view name) const;
  int detail() const { return count("detail"); }

 private:
  std::size_t index(std::string_view name) const;
  const ElementKind* kind_ = nullptr;
  const ProfileLibrary* profiles_ = nullptr;
  std::vector<double> numbers_;
  std::vector<ProfileProgram> programs_;  ///< of profiles and edges; empty for others and straight edges
};

/// What a generator works on.
struct Request {
  double width = 0, height = 0;
  const Values& values;
};
/// A generator fills opening and mesh. Error: what does not fit.
using Made = tl::expected<void, std::string>;
using Generator = Made (*)(const Request&, Element&);

Made make_casement_window(const Request&, Element&);
Made make_double_casement(const Request&, Element&);
Made make_shop_window(const Request&, Element&);
Made make_cellar_window(const Request&, Element&);
Made make_shaped_window(const Request&, Element&);
Made make_house_door(const Request&, Element&);
Made make_carriage_gateway(const Request&, Element&);
Made make_reveal(const Request&, Element&);
Made make_sill(const Request&, Element&);
Made make_surround(const Request&, Element&);
Made make_pediment(const Request&, Element&);
Made make_string_course(const Request&, Element&);
Made make_main_cornice(const Request&, Element&);
Made make_plinth(const Request&, Element&);
Made make_console(const Request&, Element&);
Made make_balcony(const Request&, Element&);
Made make_bay(const Request&, Element&);
Made make_quoin(const Request&, Element&);
Made make_pilaster(const Request&, Element&);

/// Straight pieces of a segmental head over an opening (m wide), and of a quarter circle of a moulding, at a level of
/// detail. Gateways and shop fronts show their arcs more than windows do.
inline int chords_at(int detail, double width) { return detail == 0 ? 2 : detail == 2 ? 8 : width > 1.6 ? 6 : 4; }
inline int arc_steps_at(int detail) { return detail == 2 ? 5 : 2; }

}  // namespace blockrand::elements
