// Small OSM files for the importer's tests, and extracts as text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "importers/osm/read_extract.h"

namespace blockrand::importers::osm::test {

/// A folder that is gone with the object.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::string path(std::string_view name) const { return folder_ + "/" + std::string(name); }
  /// Writes the bytes and returns the path.
  std::string write(std::string_view name, std::string_view bytes) const;

 private:
  std::string folder_;
};

using TagList = std::vector<std::pair<std::string, std::string>>;

/// An OSM XML file in the making. Objects appear in the order of the calls.
class OsmText {
 public:
  OsmText& node(std::int64_t id, double lon, double lat, const TagList& tags = {});
  OsmText& way(std::int64_t id, const std::vector<std::int64_t>& refs, const TagList& tags = {});
  /// \param members "w1 outer", "w2 inner", "n3", "r4 part" …
  OsmText& relation(std::int64_t id, const std::vector<std::string>& members, const TagList& tags = {});
  /// Four nodes first … first+3 at the corners of a square (in 1e-4 degrees, about 11 m) and the closed way around
  /// them.
  OsmText& square(std::int64_t way_id, std::int64_t first_node, double x, double y, double size,
                  const TagList& tags = {});
  /// The nodes alone.
  OsmText& corners(std::int64_t first_node, double x, double y, double size);
  /// Anything else, as it stands.
  OsmText& raw(std::string_view xml);

  std::string xml() const;
  /// The same objects in another order.
  std::string shuffled_xml(unsigned seed) const;
  model::Extract read(const ReadOptions& options = {}) const;

 private:
  std::vector<std::string> objects_;
};

std::string read_bytes(const std::string& path);

/// One bzip2 stream.
std::string bzip2(std::string bytes);

/// Copies an OSM file (XML where the second is .bz2) into the format of the second name, with libosmium.
void convert(const std::string& from, const std::string& to);

/// Everything in an extract but the file name, as text with strings written out and ids of strings.
std::string dump(const model::Extract& extract);

const model::MappedBuilding* building(const model::Extract& extract, std::string_view id);
const model::Feature* feature(const model::Extract& extract, std::string_view id);
/// "pending", "duplicate of w1", "represented by w1", "NODE_ONLY", or "absent".
std::string state(const model::Extract& extract, std::string_view id);
/// Details of the rows of one object with this code, joined by " | "; "-" when there are none.
std::string rows(const model::Extract& extract, std::string_view id, model::IssueCode code);
/// Number of vertices of each ring, inner ones negative.
std::vector<int> ring_sizes(const model::Extract& extract, model::Range rings);

}  // namespace blockrand::importers::osm::test
