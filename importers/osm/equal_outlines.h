// Buildings mapped twice: the same rings under two ids. Internal to this folder.
#pragma once

#include <vector>

#include "importers/osm/accounts.h"

namespace blockrand::importers::osm {

/// Groups of two or more pending accounts of one kind with the same rings, whatever their starts and directions. Groups
/// and their members are in order of id. (A building:part with the rings of its building is normal and in no group.)
std::vector<std::vector<Account*>> equal_outlines(const RawData& data, Accounts& accounts);

}  // namespace blockrand::importers::osm
