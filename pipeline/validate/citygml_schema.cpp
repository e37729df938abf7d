#include <fmt/format.h>
#include <libxml/catalog.h>
#include <libxml/parser.h>
#include <libxml/xmlschemas.h>

#include <filesystem>

#include "pipeline/base/error.h"
#include "pipeline/validate/citygml_reader.h"

namespace blockrand::validate {
namespace {

constexpr std::size_t kShown = 20;  // errors of one file

void ignore(void*, xmlErrorPtr) {}

struct Collector {
  const std::string& name;
  std::vector<Finding> findings;
};

void collect(void* context, xmlErrorPtr error) {
  auto& out = *static_cast<Collector*>(context);
  if (out.findings.size() >= kShown || !error) return;
  std::string what = error->message ? error->message : "invalid";
  while (!what.empty() && what.back() == '\n') what.pop_back();
  out.findings.push_back({Check::citygml_schema, out.name, "", fmt::format("line {}: {}", error->line, what)});
}

}  // namespace

struct CityGmlSchema::State {
  xmlSchemaPtr schema = nullptr;
  ~State() { xmlSchemaFree(schema); }
};

CityGmlSchema::CityGmlSchema(const std::string& folder) : state_(std::make_unique<State>()) {
  namespace fs = std::filesystem;
  const std::string path = (fs::path(folder) / "citygml2.xsd").string(),
                    catalog = (fs::path(folder) / "catalog.xml").string();
  if (!fs::exists(path))
    throw base::InputError(path, "", "there is no such file",
                           "--schemas names a folder with citygml2.xsd and catalog.xml");
  if (fs::exists(catalog)) xmlLoadCatalog(catalog.c_str());
  xmlSchemaParserCtxtPtr parser = xmlSchemaNewParserCtxt(path.c_str());
  if (parser) {
    xmlSchemaSetParserStructuredErrors(parser, ignore, nullptr);
    state_->schema = xmlSchemaParse(parser);
    xmlSchemaFreeParserCtxt(parser);
  }
  if (!state_->schema)
    throw base::InputError(path, "", "the schema cannot be read",
                           "It needs all schemas that it includes; catalog.xml beside it says where they are");
}

CityGmlSchema::~CityGmlSchema() = default;

std::vector<Finding> CityGmlSchema::validate(std::string_view xml, const std::string& name) const {
  Collector out{name, {}};
  xmlSchemaValidCtxtPtr context = xmlSchemaNewValidCtxt(state_->schema);
  xmlParserInputBufferPtr input =
      xml.size() > 0x7fffffff
          ? nullptr
          : xmlParserInputBufferCreateMem(xml.data(), static_cast<int>(xml.size()), XML_CHAR_ENCODING_NONE);
  if (context && input) {
    xmlSchemaSetValidStructuredErrors(context, collect, &out);
    const int status =
        xmlSchemaValidateStream(context, input, XML_CHAR_ENCODING_NONE, nullptr, nullptr);  // takes `input`
    if (status != 0 && out.findings.empty())
      out.findings.push_back({Check::citygml_schema, name, "", "does not validate"});
  }
  xmlSchemaFreeValidCtxt(context);
  return std::move(out.findings);
}

}  // namespace blockrand::validate
