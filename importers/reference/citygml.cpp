#include "importers/reference/citygml.h"

#include <libxml/SAX2.h>
#include <libxml/parser.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "importers/reference/axes.h"
#include "importers/reference/citygml_parser.h"
#include "importers/reference/file_bytes.h"
#include "importers/reference/height_words.h"
#include "importers/reference/reference_crs.h"
#include "pipeline/base/error.h"

namespace blockrand::importers::reference {
namespace {

/// What the events of a document go to, with what libxml2 complained about.
struct Document {
  CityGmlParser& parser;
  NoteLog& notes;
  bool fatal = false;
  int first_line = 0;
  std::string first;  ///< first fatal complaint

  static Document& of(void* context) {
    return *static_cast<Document*>(static_cast<xmlParserCtxtPtr>(context)->_private);
  }
  static std::string_view view(const xmlChar* text) {
    return text != nullptr ? reinterpret_cast<const char*>(text) : std::string_view();
  }

  static void start(void* context, const xmlChar* name, const xmlChar*, const xmlChar* space, int, const xmlChar**,
                    int attribute_count, int, const xmlChar** attributes) {
    of(context).parser.element({view(name), view(space), xmlSAX2GetLineNumber(context), attribute_count, attributes});
  }
  static void end(void* context, const xmlChar*, const xmlChar*, const xmlChar*) { of(context).parser.end_element(); }
  static void text(void* context, const xmlChar* characters, int length) {
    of(context).parser.text({reinterpret_cast<const char*>(characters), static_cast<std::size_t>(length)});
  }
  static void doctype(void* context, const xmlChar*, const xmlChar*, const xmlChar*) {
    of(context).parser.doctype();
    xmlStopParser(static_cast<xmlParserCtxtPtr>(context));
  }
  static void complaint(void* context, xmlErrorPtr error) {
    if (error == nullptr || error->level < XML_ERR_ERROR) return;
    Document& document = of(context);
    std::string what = error->message != nullptr ? error->message : "not well-formed";
    while (!what.empty() && what.back() == '\n') what.pop_back();
    std::replace(what.begin(), what.end(), '\n', ' ');
    if (error->level == XML_ERR_FATAL) {
      document.fatal = true;
      if (document.first.empty()) {
        document.first = what;
        document.first_line = error->line;
      }
    }
    document.notes.add(NoteKind::malformed_xml, error->line, what);
  }
};

[[noreturn]] void refuse(const std::string& path, int line, const std::string& what, const std::string& remedy) {
  throw base::InputError(path, line > 0 ? "line " + std::to_string(line) : "", what, remedy);
}

/// Sends all bytes through libxml2 to the document. Nothing is fetched and no entity expanded; an illegal byte or a
/// stray end tag is not the end.
void run(ByteReader& bytes, Document& document, const std::string& path) {
  constexpr int kFlags = XML_PARSE_NONET | XML_PARSE_HUGE | XML_PARSE_RECOVER;
  constexpr int kChunk = 1 << 16;
  xmlSAXHandler handler{};
  xmlSAXVersion(&handler, 2);
  handler.startElementNs = Document::start;
  handler.endElementNs = Document::end;
  handler.characters = Document::text;
  handler.ignorableWhitespace = Document::text;
  handler.cdataBlock = Document::text;
  handler.internalSubset = Document::doctype;
  handler.reference = nullptr;
  handler.comment = nullptr;
  handler.processingInstruction = nullptr;
  handler.serror = Document::complaint;
  std::vector<char> buffer(kChunk);
  const auto next = [&] { return static_cast<int>(bytes.read(buffer.data(), kChunk)); };
  int size = next();
  // The first bytes decide about the encoding; handlers of the library itself want the context as their user data.
  const int head = std::min(size, 4);
  const std::unique_ptr<xmlParserCtxt, void (*)(xmlParserCtxtPtr)> context(
      xmlCreatePushParserCtxt(&handler, nullptr, buffer.data(), head, nullptr), [](xmlParserCtxtPtr c) {
        xmlFreeDoc(c->myDoc);
        c->myDoc = nullptr;
        xmlFreeParserCtxt(c);
      });
  if (!context) refuse(path, 0, "libxml2 gives no parser", "");
  xmlCtxtUseOptions(context.get(), kFlags);
  context->_private = &document;
  if (size > head) xmlParseChunk(context.get(), buffer.data() + head, size - head, 0);
  while (!document.parser.facts().has_doctype && (size = next()) > 0)
    xmlParseChunk(context.get(), buffer.data(), size, 0);
  xmlParseChunk(context.get(), buffer.data(), 0, 1);
}

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
  const Box all = box_of(model);
  const bool swapped = !model.polygons.empty() && outside == model.polygons.size() &&
                       all.lowest.y >= facts.lower[0] - tolerance && all.highest.y <= facts.upper[0] + tolerance &&
                       all.lowest.x >= facts.lower[1] - tolerance && all.highest.x <= facts.upper[1] + tolerance;
  if (swapped) notes.add(NoteKind::crs, 0, "the envelope has its axes the other way round than the geometry");
}

}  // namespace

ReferenceModel read_citygml(const std::string& path, const ReadOptions& options) {
  check_readable(path);
  xmlInitParser();
  ByteReader bytes(path);
  ReferenceModel model;
  model.path = path;
  model.bytes = size_on_disk(path);
  NoteLog notes;
  CityGmlParser parser(model, notes);
  Document document{parser, notes, false, 0, ""};
  run(bytes, document, path);
  parser.cut_off();
  const DocumentFacts& facts = parser.facts();
  if (facts.has_doctype)
    refuse(path, 0, "has a document type definition, which CityGML has not", "Remove the <!DOCTYPE ...> from the file");
  if (bytes.damaged()) notes.add(NoteKind::malformed_xml, 0, "the gzip archive is cut off or damaged");
  if (model.buildings.empty()) {
    if (!facts.foreign_version.empty() && model.version.empty())
      refuse(path, 0, "is CityGML " + facts.foreign_version, "Versions 0.4, 1.0 and 2.0 are read; convert it to 2.0");
    if (facts.root.empty() || (document.fatal && !facts.city_model))
      refuse(path, document.first_line,
             "is no XML that can be read" + (document.first.empty() ? "" : ": " + document.first),
             "A CityGML file (.gml, .xml, also gzipped) is wanted");
    if (!facts.city_model)
      refuse(path, 0, "is no CityGML: its root is <" + facts.root + "> and it has no building", "");
    if (document.fatal)
      refuse(path, document.first_line, "no building can be read: " + document.first, "The file is damaged");
  }
  parser.finish();
  if (!model.buildings.empty() || !facts.srs_names.empty() || !options.reference_crs.empty())
    model.crs = decide_crs(path, facts.srs_names, options, notes);
  decide_heights(model.crs, height_words_in(facts.description));
  model.format = "CityGML " + model.version;
  compare_with_envelope(model, facts, notes);
  settle_axes(model, options, notes);
  model.notes = notes.take();
  return model;
}

}  // namespace blockrand::importers::reference
