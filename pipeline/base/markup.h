// Text and pictures inside of XML, HTML and JSON.
#pragma once

#include <string>
#include <string_view>

namespace blockrand::base {

/// Appends `text` with every byte sequence replaced by U+FFFD that is not valid UTF-8 or that XML 1.0 forbids
/// (control characters but tab, newline and carriage return; surrogates; U+FFFE, U+FFFF). Importers clean texts
/// already; this is the last line of defence, since one such byte would make a whole file unreadable.
void append_clean(std::string& out, std::string_view text);

/// Appends cleaned text as XML character data; also fit for attribute values in double quotes: & < > " are escaped,
/// and tab, newline and carriage return are written as character references, which survive attribute normalisation.
void append_xml(std::string& out, std::string_view text);

/// Appends cleaned text as a JSON string with its quotes. Non-ASCII characters stay UTF-8.
void append_json(std::string& out, std::string_view text);

/// Text escaped for XML and HTML alike: append_xml.
std::string escaped(std::string_view text);

/// For pictures that stand in the page itself (RFC 4648, section 4).
void append_base64(std::string& out, std::string_view bytes);

}  // namespace blockrand::base
