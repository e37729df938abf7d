#include "pipeline/cli/schedule_quoting.h"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/base/error.h"
#include "pipeline/base/markup.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/text.h"

namespace blockrand::cli {
namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("/._-+=:@,").find(c) != std::string_view::npos;
}
bool all_plain(std::string_view text) { return !text.empty() && std::ranges::all_of(text, is_plain); }

std::string with_percent_doubled(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '%' ? "%%" : std::string(1, c);
  return out;
}

}  // namespace

std::string quoted_for_sh(std::string_view text) {
  if (all_plain(text)) return std::string(text);
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

std::string quoted_for_systemd(std::string_view text) {
  if (all_plain(text)) return std::string(text);
  std::string out = "\"";
  for (const char c : with_percent_doubled(text)) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string exec_line(std::vector<std::string> words) {
  // The name of a program is held to more than other words, whatever quotes are around it.
  if (words.front().find_first_of("\"'\\") != std::string::npos)
    words.insert(words.begin(), {"/bin/sh", "-c", "exec \"$0\" \"$@\""});
  const bool dollar =
      std::ranges::any_of(words, [](const std::string& word) { return word.find('$') != std::string::npos; });
  std::string out = dollar ? ":" : "";  // variables are not replaced
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) out += ' ';
    out += words[i] == ";" ? "\\;" : quoted_for_systemd(words[i]);
  }
  return out;
}

std::string plain_for_systemd(std::string_view text) {
  if (text.ends_with(' ') || text.ends_with('\\'))
    throw base::UsageError(std::string(text) +
                           ": a path that ends with a space or a backslash cannot be written in a unit of systemd. "
                           "Call the command from another folder.");
  return with_percent_doubled(text);
}

std::string unit_name(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool plain = is_plain(c) && c != '/' && c != '+' && c != '=' && c != ',' && c != '@';
    out += plain ? std::string(1, c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  }
  return out;
}

std::string cron_command(std::string_view command) {
  constexpr std::size_t kLongest = 990;  // bytes: cron of Debian takes 1000 (MAX_COMMAND), with its end
  std::string out;
  for (std::size_t i = 0; i < command.size(); ++i) {
    if (command[i] == '\\' && i + 1 < command.size() && (command[i + 1] == '\\' || command[i + 1] == '%'))
      throw base::UsageError(
          "a backslash before a backslash or a percent sign cannot be written in a crontab: one cron reads it "
          "otherwise than another. Give the region by a link without, or write --print systemd.");
    out += command[i] == '%' ? "\\%" : std::string(1, command[i]);
  }
  if (out.size() > kLongest)
    throw base::UsageError(
        fmt::format("the line of the crontab would have {} characters, and cron takes {}. Use "
                    "shorter paths, or --print systemd.",
                    out.size(), kLongest));
  return out;
}

std::string quoted_for_yaml(std::string_view text) {
  std::string out;
  base::append_json(out, text);
  return out;
}

std::string kubernetes_name(std::string_view text) {
  constexpr std::size_t kLongest = 40;  // names of jobs of a CronJob: 52 with what is before; of pods 63
  std::string out;
  for (const char c : text) {
    const char low = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const bool fits = (low >= 'a' && low <= 'z') || (low >= '0' && low <= '9');
    if (fits)
      out += low;
    else if (!out.empty() && out.back() != '-')
      out += '-';
  }
  while (out.ends_with('-')) out.pop_back();
  if (out == text && out.size() <= kLongest) return out;
  out = out.substr(0, kLongest - 7);
  while (out.ends_with('-')) out.pop_back();
  return (out.empty() ? "r" : out) + "-" + base::sha256_of(text).substr(0, 6);
}

void check_text(std::string_view what, std::string_view text) {
  std::string clean;
  base::append_clean(clean, text);
  const bool control =
      std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; });
  if (control || clean != text)
    throw base::UsageError(
        fmt::format("{} ({}) holds a control character or bytes that are not UTF-8: files of "
                    "schedulers cannot have it. Use a link without these.",
                    what, base::json_quoted(text)));
}

}  // namespace blockrand::cli
