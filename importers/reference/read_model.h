// One door to all formats of reference models.
#pragma once

#include <string>
#include <vector>

#include "importers/reference/read_options.h"
#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference {

/// Reads CityGML, CityJSON (also as text sequence), glTF or a 3D Tiles tileset, told by the content, gzipped or not.
/// \throws base::InputError  when there is no such file, it is of none of these formats, or its reader refuses it
/// \throws base::UsageError  as the readers
ReferenceModel read_model(const std::string& path, const ReadOptions& options = {});

/// The model files that a path stands for, in the order of their names.
///
/// A file stands for itself. A build of Blockrand (a folder with build.json) stands for the files of its best format:
/// those in citygml/, else those in cityjson/, else tileset.json, else its GLBs. Any other folder stands for all model
/// files in it and below, known by their names: .gml, .xml, .json, .jsonl, .glb, .gltf, also with .gz; not what a
/// tileset.json in the same folder or above it places, nor JSON that is no model.
/// \throws base::InputError  when there is no such path, or no model file in the folder
std::vector<std::string> model_files(const std::string& path);

}  // namespace blockrand::importers::reference
