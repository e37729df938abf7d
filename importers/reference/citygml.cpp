#include "importers/reference/citygml.h"

#include <libxml/xmlreader.h>
#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>

#include "importers/reference/citygml_parser.h"
#include "importers/reference/reference_crs.h"
#include "pipeline/base/error.h"

namespace blockrand::importers::reference {
namespace {

/// Bytes of a plain or gzipped file; zlib tells them apart.
class Bytes {
 public:
  explicit Bytes(const std::string& path) : file_(gzopen(path.c_str(), "rb")) {
    constexpr unsigned kBuffer = 1U << 18;
    if (file_ != nullptr) gzbuffer(file_, kBuffer);
  }
  ~Bytes() {
    if (file_ != nullptr) gzclose(file_);
  }
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;

  bool open() const { return file_ != nullptr; }
  bool damaged() const { return damaged_; }

  /// For libxml2. A damaged archive ends where it is damaged, so that what came before is read.
  static int read(void* self, char* buffer, int length) {
    auto& bytes = *static_cast<Bytes*>(self);
    const int got = gzread(bytes.file_, buffer, static_cast<unsigned>(length));
    int error = Z_OK;
    gzerror(bytes.file_, &error);
    if (got < 0 || error == Z_BUF_ERROR || error == Z_DATA_ERROR) bytes.damaged_ = true;
    return std::max(0, got);
  }

 private:
  gzFile file_;
  bool damaged_ = false;
};

/// What libxml2 complained about.
struct XmlErrors {
  NoteLog& notes;
  bool fatal = false;
  int first_line = 0;
  std::string first;

  static void collect(void* self, xmlErrorPtr error) {
    auto& errors = *static_cast<XmlErrors*>(self);
    if (error == nullptr || error->level < XML_ERR_ERROR) return;
    std::string what = error->message != nullptr ? error->message : "not well-formed";
    while (!what.empty() && what.back() == '\n') what.pop_back();
    if (error->level == XML_ERR_FATAL) {
      errors.fatal = true;
      if (errors.first.empty()) {
        errors.first = what;
        errors.first_line = error->line;
      }
    }
    errors.notes.add(NoteKind::malformed_xml, error->line, what);
  }
};

[[noreturn]] void refuse(const std::string& path, int line, const std::string& what, const std::string& remedy) {
  throw base::InputError(path, line > 0 ? "line " + std::to_string(line) : "", what, remedy);
}

void check_path(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::exists(path, error)) refuse(path, 0, "there is no such file", "");
  if (fs::is_directory(path, error)) refuse(path, 0, "is a directory", "Name the CityGML files in it");
  if (fs::file_size(path, error) == 0 && !error) refuse(path, 0, "is empty", "");
}

/// Feeds the parser until the text ends. \return false where it ended too early
bool run(xmlTextReaderPtr reader, CityGmlParser& parser) {
  int status = 0;
  while ((status = xmlTextReaderRead(reader)) == 1) {
    switch (xmlTextReaderNodeType(reader)) {
      case XML_READER_TYPE_ELEMENT:
        parser.element(reader);
        break;
      case XML_READER_TYPE_END_ELEMENT:
        parser.end_element();
        break;
      case XML_READER_TYPE_TEXT:
      case XML_READER_TYPE_CDATA:
      case XML_READER_TYPE_SIGNIFICANT_WHITESPACE: {
        const xmlChar* value = xmlTextReaderConstValue(reader);
        if (value != nullptr) parser.text(reinterpret_cast<const char*>(value));
        break;
      }
      case XML_READER_TYPE_DOCUMENT_TYPE:
        parser.doctype();
        return true;
      default:
        break;
    }
  }
  return status == 0;
}

struct Box {
  model::Point3 lowest{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                       std::numeric_limits<double>::infinity()};
  model::Point3 highest{-lowest.x, -lowest.y, -lowest.z};
  void add(const model::Point3& p) {
    lowest = {std::min(lowest.x, p.x), std::min(lowest.y, p.y), std::min(lowest.z, p.z)};
    highest = {std::max(highest.x, p.x), std::max(highest.y, p.y), std::max(highest.z, p.z)};
  }
};

/// Notes polygons that reach out of the envelope; both in the file's axis order.
void compare_with_envelope(const ReferenceModel& model, const DocumentFacts& facts, NoteLog& notes) {
  if (facts.lower.size() < 2 || facts.upper.size() < 2) return;
  const double tolerance = model.crs.geographic ? 1e-7 : 0.01;  // degrees; m: envelopes are rounded
  std::size_t outside = 0;
  for (const Polygon3& polygon : model.polygons) {
    Box box;
    for (const model::Point3& p : polygon.outer) box.add(p);
    if (box.lowest.x >= facts.lower[0] - tolerance && box.lowest.y >= facts.lower[1] - tolerance &&
        box.highest.x <= facts.upper[0] + tolerance && box.highest.y <= facts.upper[1] + tolerance)
      continue;
    ++outside;
    notes.add(NoteKind::outside_envelope, 0, "polygon \"" + polygon.id + "\"");
  }
  Box all;
  for (const Polygon3& polygon : model.polygons)
    for (const model::Point3& p : polygon.outer) all.add(p);
  const bool swapped = !model.polygons.empty() && outside == model.polygons.size() &&
                       all.lowest.y >= facts.lower[0] - tolerance && all.highest.y <= facts.upper[0] + tolerance &&
                       all.lowest.x >= facts.lower[1] - tolerance && all.highest.x <= facts.upper[1] + tolerance;
  if (swapped) notes.add(NoteKind::crs, 0, "the envelope has its axes the other way round than the geometry");
}

void swap_axes(ReferenceModel& model) {
  const auto swap = [](std::vector<model::Point3>& ring) {
    for (model::Point3& p : ring) std::swap(p.x, p.y);
  };
  for (Polygon3& polygon : model.polygons) {
    swap(polygon.outer);
    for (auto& hole : polygon.holes) swap(hole);
  }
}

}  // namespace

ReferenceModel read_citygml(const std::string& path, const ReadOptions& options) {
  check_path(path);
  Bytes bytes(path);
  if (!bytes.open()) refuse(path, 0, "cannot be opened", "");
  ReferenceModel model;
  model.path = path;
  NoteLog notes;
  XmlErrors errors{notes, false, 0, ""};
  CityGmlParser parser(model, notes);
  {
    // Nothing is fetched and no entity expanded. RECOVER: an illegal byte or a stray end tag is not the end.
    constexpr int kFlags = XML_PARSE_NONET | XML_PARSE_HUGE | XML_PARSE_RECOVER | XML_PARSE_COMPACT;
    const std::unique_ptr<xmlTextReader, void (*)(xmlTextReaderPtr)> reader(
        xmlReaderForIO(Bytes::read, nullptr, &bytes, nullptr, nullptr, kFlags), xmlFreeTextReader);
    if (!reader) refuse(path, 0, "libxml2 gives no reader", "");
    xmlTextReaderSetStructuredErrorHandler(reader.get(), XmlErrors::collect, &errors);
    if (!run(reader.get(), parser) || bytes.damaged()) parser.cut_off();
  }
  const DocumentFacts& facts = parser.facts();
  if (facts.has_doctype)
    refuse(path, 0, "has a document type definition, which CityGML has not", "Remove the <!DOCTYPE ...> from the file");
  if (bytes.damaged()) notes.add(NoteKind::malformed_xml, 0, "the gzip archive is cut off or damaged");
  if (model.buildings.empty()) {
    if (!facts.foreign_version.empty() && model.version.empty())
      refuse(path, 0, "is CityGML " + facts.foreign_version, "Versions 0.4, 1.0 and 2.0 are read; convert it to 2.0");
    if (facts.root.empty() || (errors.fatal && !facts.city_model))
      refuse(path, errors.first_line, "is no XML that can be read" + (errors.first.empty() ? "" : ": " + errors.first),
             "A CityGML file (.gml, .xml, also gzipped) is wanted");
    if (!facts.city_model)
      refuse(path, 0, "is no CityGML: its root is <" + facts.root + "> and it has no building", "");
    if (errors.fatal)
      refuse(path, errors.first_line, "no building can be read: " + errors.first, "The file is damaged");
  }
  parser.finish();
  Box box;
  for (const Polygon3& polygon : model.polygons)
    for (const model::Point3& p : polygon.outer) box.add(p);
  if (!model.buildings.empty() || !facts.srs_names.empty() || !options.reference_crs.empty())
    model.crs = decide_crs(path, facts.srs_names, options, notes);
  compare_with_envelope(model, facts, notes);
  if (!model.polygons.empty()) {
    decide_axis_order(model.crs, box.lowest.xy(), box.highest.xy(), options, notes);
    if (model.crs.axis_order == AxisOrder::north_first) swap_axes(model);
  }
  model.notes = notes.take();
  return model;
}

}  // namespace blockrand::importers::reference
