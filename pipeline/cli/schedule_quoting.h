// Paths and commands in the files of schedulers: each has its own way to quote. Internal to this folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace blockrand::cli {

/// One word of sh.
std::string quoted_for_sh(std::string_view text);

/// The value of ExecStart= and its kin (systemd.service(5), "Command lines"): no word is changed by specifiers or variables.
/// \param words  the program first, an absolute path
std::string exec_line(std::vector<std::string> words);

/// One word of a list of paths, as in ReadWritePaths=, or of Environment= (systemd.exec(5)).
std::string quoted_for_systemd(std::string_view text);

/// A value that systemd takes as it stands up to the end of the line, as WorkingDirectory= and Description=.
/// \throws base::UsageError  it ends with a space or a backslash, which cannot be written there
std::string plain_for_systemd(std::string_view text);

/// The part of a unit's name that stands for any text (systemd.unit(5), "String escaping"), but that dashes stay.
std::string unit_name(std::string_view text);

/// A command of sh as a crontab has it (crontab(5)).
/// \throws base::UsageError  it holds a backslash before a backslash or a percent sign, which crons read differently, or is longer
/// than crons take
std::string cron_command(std::string_view command);

/// A YAML string of any printable text: in double quotes, as JSON.
std::string quoted_for_yaml(std::string_view text);

/// A name that Kubernetes takes: lower-case letters, digits, dashes, at most 40 characters. Another one for another text.
std::string kubernetes_name(std::string_view text);

/// \param what  how the message calls it: "the region's path"
/// \throws base::UsageError  it holds control characters or bytes that are not UTF-8: no scheduler takes these
void check_text(std::string_view what, std::string_view text);

}  // namespace blockrand::cli
