// LoD3: facades by rule files. Wall segment by wall segment of each wall the grammar of the building's preset says where windows,
// doors and ornaments go; they are cut into the LoD2 solid and placed.
#pragma once

#include <cstdint>

#include "pipeline/attributes/defaults.h"
#include "pipeline/facades/grammar_library.h"
#include "pipeline/masses/built_mass.h"
#include "pipeline/model/region.h"

namespace blockrand::facades {

struct FacadeOptions {
  std::uint64_t seed = 0;
  std::size_t most_shapes = 20000;  ///< of one wall segment; what is beyond is left out and told
};

/// Builds `lod3` of every part of the region's owned buildings that has a LoD2 solid and a preset with a grammar.
///
/// The initial shape of a derivation is the wall's polygon between the ends of the wall segment: x to the viewer's right
/// from its left end, y up from the wall's base, z out of it. docs/grammar_attributes.md lists what rules can ask of
/// building, edge and roof. Party walls, and walls that no wall segment of the outline runs along, stay closed. Random
/// numbers are keyed by the building's id and the number of the wall and wall segment.
///
/// The main body of a building gets what its preset's rules for roofs order (roof_elements.h): dormers and cross gables are part of
/// the LoD3 solid, with windows in their fronts; gables get windows, too.
///
/// LoD2 is not touched: rebuilding with another preset leaves it byte for byte. What an opening may not do is decided
/// by cut_openings(); those that do not fit are left out and counted (OPENING_LEFT_OUT); a solid that fails its check
/// is tried again without passages, and else keeps closed walls (FACADE_FAILED). Elements that cannot be made as a
/// rule asks are made simpler or left out, and told as GRAMMAR_ERROR with what was made instead.
/// \param masses  of the same region: the roofs that its LoD2 solids have; those get what is built on them. Null: none of it
void build_facades(model::Region& region, const GrammarLibrary& grammars, const attributes::Defaults& defaults,
                   const FacadeOptions& options, masses::BuiltMasses* masses = nullptr);

}  // namespace blockrand::facades
