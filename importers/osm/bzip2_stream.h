// Reading bzip2 files of several streams, as pbzip2 writes them (planet.osm.bz2 and most extracts). Internal.
#pragma once

namespace blockrand::importers::osm {

/// Makes libosmium read `.bz2` with our decompressor. Its own (2.19) stops after a stream when the rest of the file is
/// already in its buffer, so that a file whose last stream is shorter than 5000 bytes looks cut off, and it takes
/// rubbish after the end for nothing. Has no effect where osmium/io/bzip2_compression.hpp was included before.
void use_own_bzip2();

}  // namespace blockrand::importers::osm
