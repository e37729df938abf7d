// Portals of tunnels.
#pragma once

#include <vector>

#include "pipeline/surroundings/body_site.h"

namespace blockrand::surroundings {

/// Where a street or a track with tunnel=yes begins in the open: a frame of concrete across its width, dark behind. The open goes on
/// there as a street or a track that is mapped. None where a building stands, or where the ground over the beginning of the tunnel
/// belongs to traffic: it passes below a street at once, and no ground shows how deep it lies.
std::vector<model::SurroundingBody> portal_bodies(const BodySite& site, const Thing& thing);

}  // namespace blockrand::surroundings
