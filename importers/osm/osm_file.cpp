#include "importers/osm/osm_file.h"

#include <expat.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <osmium/io/gzip_compression.hpp>
#include <osmium/io/pbf_input.hpp>
#include <osmium/io/reader.hpp>
#include <osmium/io/xml_input.hpp>
#include <osmium/thread/pool.hpp>
#include <type_traits>

#include "importers/osm/bzip2_stream.h"
#include "importers/osm/pbf_blobs.h"
#include "pipeline/base/error.h"

namespace blockrand::importers::osm {
namespace {

constexpr const char* kFetchAgain = "The file is damaged or was cut off: fetch or write it again";

struct Kind {
  std::string_view suffix, format, words;
};
constexpr Kind kKinds[] = {{".osm.pbf", "pbf", "PBF"},
                           {".pbf", "pbf", "PBF"},
                           {".osm.gz", "xml.gz", "gzip"},
                           {".osm.bz2", "xml.bz2", "bzip2"},
                           {".osm", "xml", "XML"}};

/// A file that was opened by another program or another part of this one has no name that says anything.
bool has_no_name(const std::string& path) {
  return path.starts_with("/proc/self/fd/") || path.starts_with("/dev/fd/") || path == "/dev/stdin";
}

constexpr std::string_view kO5m = "\xff\xe0\x04o5";
constexpr const char* kConvert = "Convert it: osmium cat FILE.o5m -o FILE.osm.pbf";

std::string format_by_name(const std::string& path) {
  std::string name = path;
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (name.ends_with(".o5m")) throw base::InputError(path, "", "files of the format o5m are not read", kConvert);
  for (const char* changes : {".osc", ".osc.gz", ".osc.bz2"})
    if (name.ends_with(changes))
      throw base::InputError(
          path, "", "this is a change file by its name, not an extract",
          "A region takes change files: blockrand update REGION FILE.osc.gz. Or apply it to an extract: "
          "osmium apply-changes EXTRACT CHANGES -o NEW.osm.pbf");
  for (const Kind& kind : kKinds)
    if (name.ends_with(kind.suffix)) return std::string(kind.format);
  throw base::InputError(path, "", "the name does not say in which format the file is",
                         "Names end in .osm, .osm.gz, .osm.bz2, .osm.pbf or .pbf");
}

/// What the first bytes look like; empty when they tell nothing.
std::string format_by_content(std::string_view head) {
  if (head.starts_with("\x1f\x8b")) return "xml.gz";
  if (head.starts_with("BZh")) return "xml.bz2";
  if (head.size() > 14 && head.substr(4, 11) == "\x0a\x09OSMHeader") return "pbf";
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  const auto first = head.find_first_not_of(" \t\r\n");
  if (first != std::string_view::npos && head[first] == '<') return "xml";
  return "";
}

/// The name of the root element of an XML text; empty where `head` ends before it or holds none.
std::string_view root_element(std::string_view head) {
  std::size_t at = 0;
  while ((at = head.find('<', at)) != std::string_view::npos) {
    std::string_view rest = head.substr(at + 1);
    if (rest.starts_with("!--")) {
      at = head.find("-->", at);
    } else if (rest.starts_with('?') || rest.starts_with('!')) {
      at = head.find('>', at);
    } else {
      const std::size_t end = rest.find_first_of(" \t\r\n/>");
      return end == std::string_view::npos ? std::string_view() : rest.substr(0, end);
    }
    if (at == std::string_view::npos) break;
  }
  return {};
}

/// A change file holds what was done between two states of the map, not a state.
void refuse_changes(const std::string& path, std::string_view head) {
  if (root_element(head) == "osmChange")
    throw base::InputError(path, "", "this is a change file (osmChange), not an extract",
                           "Apply it to an extract first: osmium apply-changes EXTRACT CHANGES -o NEW.osm.pbf");
}

std::string words_for(std::string_view format) {
  for (const Kind& kind : kKinds)
    if (kind.format == format) return std::string(kind.words);
  return "unknown";
}

/// The objects with action="delete" in an XML stream.
class DeletionFinder {
 public:
  explicit DeletionFinder(std::unordered_set<std::int64_t>* deleted)
      : deleted_(deleted), parser_(XML_ParserCreate(nullptr)) {
    XML_SetUserData(parser_, this);
    XML_SetStartElementHandler(parser_, [](void* self, const XML_Char* name, const XML_Char** attributes) {
      static_cast<DeletionFinder*>(self)->start(name, attributes);
    });
  }
  ~DeletionFinder() { XML_ParserFree(parser_); }
  DeletionFinder(const DeletionFinder&) = delete;
  DeletionFinder& operator=(const DeletionFinder&) = delete;

  /// False when the text is no XML: the real reader will say so with the place.
  bool feed(const std::string& text) {
    return XML_Parse(parser_, text.data(), static_cast<int>(text.size()), 0) != XML_STATUS_ERROR;
  }

 private:
  void start(std::string_view name, const XML_Char** attributes) {
    const int type = name == "node" ? 0 : name == "way" ? 1 : name == "relation" ? 2 : -1;
    if (type < 0) return;
    bool deleted = false;
    std::int64_t id = 0;
    for (; *attributes != nullptr; attributes += 2) {
      const std::string_view key = attributes[0], value = attributes[1];
      if (key == "id") std::from_chars(value.data(), value.data() + value.size(), id);
      if (key == "action" && value == "delete") deleted = true;
    }
    if (deleted) deleted_[type].insert(id);
  }
  std::unordered_set<std::int64_t>* deleted_;
  XML_Parser parser_;
};

}  // namespace

struct OsmFile::Workers {
  osmium::thread::Pool pool{2};
};

OsmFile::~OsmFile() = default;

OsmFile::OsmFile(const std::string& path) : path_(path), workers_(std::make_unique<Workers>()) {
  use_own_bzip2();
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw base::InputError(path, "", "there is no such file", "Check the path");
  if (fs::is_directory(status)) throw base::InputError(path, "", "this is a directory", "Name the OSM file itself");
  if (!fs::is_regular_file(status))
    throw base::InputError(path, "", "this is not a regular file",
                           "The file is read several times: save it first, or pipe it in and name - as the extract");
  if (!has_no_name(path)) format_ = format_by_name(path);
  file_name_ = fs::absolute(path).string();

  std::ifstream in(file_name_, std::ios::binary);
  if (!in) throw base::InputError(path, "", "cannot be opened", "Check the permissions of the file");
  std::string head(512, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  if (head.empty()) throw base::InputError(path, "", "the file is empty", "Fetch or write it again");
  const std::string content = format_by_content(head);
  if (head.starts_with(kO5m)) throw base::InputError(path, "byte 0", "the content is o5m, which is not read", kConvert);
  if (has_no_name(path)) {
    if (content.empty())
      throw base::InputError(path, "byte 0",
                             "the content is no OSM data: neither PBF nor XML, nor that in gzip or bzip2",
                             "Check what writes it; osmium needs the format: osmium cat IN.osm.pbf -f pbf -o -");
    format_ = content;
  }
  if (content != format_)
    throw base::InputError(path, "byte 0",
                           content.empty()
                               ? "the content is not " + words_for(format_) + ", as the name says"
                               : "the content is " + words_for(content) + ", but the name says " + words_for(format_),
                           content.empty() ? kFetchAgain : "Rename the file to what it is");
  if (format_ == "pbf")
    check_pbf_structure(file_name_);
  else
    find_deletions();
}

OsmFile::OsmFile(std::string name, std::function<void(osmium::osm_entity_bits::type, const Visit&)> visit_all)
    : stored_(std::move(visit_all)), path_(std::move(name)) {}

void OsmFile::find_deletions() {
  const osmium::io::File file(file_name_, format_ == "xml" ? "osm" : format_ == "xml.gz" ? "osm.gz" : "osm.bz2");
  const auto open = [&] {
    return osmium::io::CompressionFactory::instance().create_decompressor(
        file.compression(), osmium::io::detail::open_for_reading(file.filename()));
  };
  try {
    // Only editors write `action`: a search through the text is many times faster than parsing it.
    bool found = false;
    {
      const auto source = open();
      std::string text, tail;
      for (bool first = true; !found && !(text = source->read()).empty(); first = false) {
        if (first) refuse_changes(path_, text);
        tail += text.substr(0, 16);
        found = text.find(" action=") != std::string::npos || tail.find(" action=") != std::string::npos;
        tail = text.size() > 16 ? text.substr(text.size() - 16) : text;
      }
    }
    if (!found) return;
    const auto source = open();
    DeletionFinder finder(deleted_);
    std::string text;
    while (!(text = source->read()).empty())
      if (!finder.feed(text)) return;
  } catch (const base::InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw base::InputError(path_, "", error.what(), kFetchAgain);
  }
}

bool OsmFile::deleted_by_editor(osmium::item_type type, std::int64_t id) const {
  const int index = type == osmium::item_type::node ? 0 : type == osmium::item_type::way ? 1 : 2;
  return !deleted_[index].empty() && deleted_[index].contains(id);
}

void OsmFile::clean_strings() {
  CleanedPbf cleaned = clean_pbf_strings(file_name_);
  buffer_ = std::move(cleaned.bytes);
  cleaned_ = std::move(cleaned.cleaned);
}

void throw_in_words(const std::string& path) {
  const auto unreadable = [&](const std::exception& error) {
    return base::InputError(path, "", error.what(), kFetchAgain);
  };
  try {
    throw;
  } catch (const osmium::xml_error& error) {
    // expat's text without its place, which stands where all places stand.
    std::string what = error.what();
    if (const std::size_t place = what.find(" at line ");
        place != std::string::npos && what.find(": ", place) != std::string::npos)
      what.erase(place, what.find(": ", place) - place);
    throw base::InputError(
        path, error.line > 0 ? "line " + std::to_string(error.line) + ", column " + std::to_string(error.column) : "",
        what, kFetchAgain);
  } catch (const osmium::io_error& error) {
    throw unreadable(error);
  } catch (const osmium::invalid_location& error) {
    throw base::InputError(path, "", error.what(), "A longitude or latitude is not a number; mend the file");
  } catch (const protozero::exception& error) {
    throw unreadable(error);
  } catch (const std::system_error& error) {
    throw unreadable(error);
  } catch (const std::logic_error& error) {  // libosmium: ids out of range, strings too long, indexes outside a table
    throw unreadable(error);
  } catch (const std::range_error& error) {
    throw unreadable(error);
  }
}

void OsmFile::for_each(osmium::osm_entity_bits::type type, const Visit& visit, const Progress& progress) {
  if (stored_) return stored_(type, visit);
  try {
    const osmium::io::File file = !buffer_.empty() ? osmium::io::File(buffer_.data(), buffer_.size(), "pbf")
                                                   : osmium::io::File(file_name_, format_ == "xml"      ? "osm"
                                                                                  : format_ == "xml.gz" ? "osm.gz"
                                                                                  : format_ == "pbf"    ? "pbf"
                                                                                                        : "osm.bz2");
    osmium::io::Reader reader(file, type, workers_->pool);
    while (osmium::memory::Buffer buffer = reader.read()) {
      for (const auto& object : buffer.select<osmium::OSMObject>()) visit(object);
      if (progress && reader.file_size() > 0)
        progress(std::min(1.0, static_cast<double>(reader.offset()) / static_cast<double>(reader.file_size())));
    }
    reader.close();
  } catch (const std::exception&) {
    throw_in_words(path_);
  }
}

}  // namespace blockrand::importers::osm
