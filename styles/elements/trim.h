// What frames an opening on the wall: surround, keystone, sill, pediment. Internal to this folder.
#pragma once

#include "styles/elements/parameters.h"

namespace blockrand::elements {

/// Adds the surround that the values ask for.
/// \param foot  the band runs along the lower edge too
Made add_surround(MeshBuilder& builder, const OpeningShape& shape, const Outline& outline, const Values& values,
                  bool foot);

/// A sill under an opening: its slab in front of the wall, and its tongue in the reveal. The upper edge at the wall is
/// kSillLip above y = `top`.
/// \param overhang  m beyond the opening at each end
Made add_sill(MeshBuilder& builder, double width, double top, double height, double overhang, double reveal,
              const Values& values, bool moulded);
inline constexpr double kSillLip = 0.012;

/// A straight, triangular or segmental hood with its lower edge at `base`.
/// \param span     m, without what its mouldings stand out at both ends
Made add_pediment(MeshBuilder& builder, double span, double base, double height, std::string_view shape,
                  const Values& values);

/// Surround, sill and pediment of a window or door, as far as its kind has them.
Made add_trim(MeshBuilder& builder, const OpeningShape& shape, const Outline& outline, double reveal,
              const Values& values);

/// The opening that the values describe.
OpeningShape opening_shape(const Request& request);

}  // namespace blockrand::elements
