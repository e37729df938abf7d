// Passwords in the names of databases: kept out of whatever people read.
#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "pipeline/base/error.h"
#include "pipeline/outward/postgis.h"

namespace blockrand::outward {
namespace {

struct Span {
  std::size_t first = 0, size = 0;
};

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The value behind '=' of a "key=value" list: bare up to a blank, or in single quotes (libpq, "Keyword/Value Connection Strings").
Span value_at(const std::string& text, std::size_t at) {
  while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at]))) ++at;
  if (at < text.size() && text[at] == '\'') {
    std::size_t end = at + 1;
    while (end < text.size() && text[end] != '\'') end += text[end] == '\\' ? 2 : 1;
    end = std::min(end, text.size());
    return {at + 1, end - at - 1};
  }
  const bool uri = text.find("://") != std::string::npos;
  std::size_t end = at;
  while (end < text.size() && !std::isspace(static_cast<unsigned char>(text[end])) && !(uri && text[end] == '&')) ++end;
  return {at, end - at};
}

/// Where passwords stand: values of `password` and `sslpassword`, and between user and host of an address.
std::vector<Span> passwords_in(const std::string& connection) {
  std::vector<Span> out;
  std::string lower = connection;
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::string_view kKey = "password";
  for (std::size_t at = lower.find(kKey); at != std::string::npos; at = lower.find(kKey, at + 1)) {
    std::size_t equals = at + kKey.size();
    while (equals < lower.size() && std::isspace(static_cast<unsigned char>(lower[equals]))) ++equals;
    const bool of_ssl = at >= 3 && lower.compare(at - 3, 3, "ssl") == 0;
    const bool whole = at == 0 || !is_name(lower[at - 1]) || of_ssl;
    if (whole && equals < lower.size() && lower[equals] == '=')
      if (const Span value = value_at(connection, equals + 1); value.size > 0) out.push_back(value);
  }
  if (const std::size_t scheme = connection.find("://"); scheme != std::string::npos) {
    // libpq looks for '@' up to the first '/': a '?' before it belongs to the password.
    const std::size_t begin = scheme + 3, end = std::min(connection.find('/', begin), connection.size());
    const std::size_t host = connection.rfind('@', end), colon = connection.find(':', begin);
    if (host != std::string::npos && host > begin && colon != std::string::npos && colon + 1 < host)
      out.push_back({colon + 1, host - colon - 1});
  }
  std::ranges::sort(out, std::greater<>(), &Span::first);
  return out;
}

}  // namespace

std::string without_password(const std::string& connection) {
  std::string out = connection;
  for (const Span& span : passwords_in(connection)) out.replace(span.first, span.size, "***");
  return out;
}

std::string clean_of_passwords(std::string text, const std::string& connection) {
  for (const Span& span : passwords_in(connection)) {
    const std::string secret = connection.substr(span.first, span.size);
    for (std::size_t at = text.find(secret); at != std::string::npos; at = text.find(secret, at + 3))
      text.replace(at, secret.size(), "***");
  }
  return text;
}

void refuse_password_in(const std::string& settings_file, const std::string& connection) {
  if (passwords_in(connection).empty()) return;
  throw base::InputError(settings_file, "[publish] postgis",
                         "holds a password, and copies and logs of this file would show it",
                         "Take it out, and put it into ~/.pgpass or a service file of PostgreSQL (service=NAME)");
}

}  // namespace blockrand::outward
