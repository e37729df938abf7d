// A CityJSON file read back: bodies, solids and colours, and whether it keeps the specification's rules.
#pragma once

#include <string>
#include <string_view>

#include "pipeline/validate/contents.h"

namespace blockrand::validate {

/// Reads CityJSON 2.0 (https://www.cityjson.org/specs/2.0.1/) as Blockrand writes it: a text sequence where the name of
/// the file contains ".jsonl", else one CityJSON object. Checks
/// - members: those required are there and of their type, no unknown ones where the specification allows none, none
/// twice;
/// - vertices: three integers each, every one used, none twice; the transform; an extent that holds them all;
/// - city objects: known types, parents and children that name each other, ids given once in the file;
/// - geometries: depth of the boundaries, indices in range, rings, an LoD that fits the type; semantics and materials
///   parallel to the surfaces and in range;
/// - a sequence: a first line without city objects, then one feature a line whose id is its only first-level object;
/// - attributes: a source and a confidence for each, the standard names saying the same as the model's.
/// Coordinates come back in the build CRS as they are written. Never throws on account of the bytes. A sequence takes
/// the memory of its longest line, an object about ten times its bytes.
/// \param name  of the file, for findings: CITYJSON_RULE, OFF_GRID, SOURCE_WRONG, FILE_UNREADABLE
Contents read_cityjson(std::string_view text, const std::string& name);

}  // namespace blockrand::validate
