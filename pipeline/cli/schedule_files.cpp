#include "pipeline/cli/schedule_files.h"

#include <fmt/format.h>

#include "pipeline/base/text.h"
#include "pipeline/cli/schedule_quoting.h"

namespace blockrand::cli {
namespace {

/// Update with what the command line of `schedule` said.
std::vector<std::string> update_words(const Schedule& s) {
  std::vector<std::string> words = {s.program, "update", s.region, "--progress", "none"};
  if (s.max_age_hours > 0) words.insert(words.end(), {"--max-age", base::shortest(s.max_age_hours)});
  return words;
}

/// EnvironmentFile= is a pattern (glob(7)).
std::string as_pattern(std::string_view path) {
  std::string out;
  for (const char c : path) {
    if (c == '*' || c == '?' || c == '[' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

/// What a build does not need. Each line is one that `systemd-analyze security` asks for.
constexpr const char* kSandbox = R"(ProtectSystem=strict
ProtectHome=read-only
NoNewPrivileges=yes
PrivateDevices=yes
DevicePolicy=closed
ProtectKernelTunables=yes
ProtectKernelModules=yes
ProtectKernelLogs=yes
ProtectControlGroups=yes
ProtectClock=yes
ProtectHostname=yes
ProtectProc=invisible
RestrictNamespaces=yes
RestrictRealtime=yes
RestrictSUIDSGID=yes
LockPersonality=yes
MemoryDenyWriteExecute=yes
RemoveIPC=yes
KeyringMode=private
CapabilityBoundingSet=
AmbientCapabilities=
SystemCallArchitectures=native
SystemCallFilter=@system-service
SystemCallFilter=~@privileged
SystemCallErrorNumber=EPERM
UMask=0022
)";

std::string memory_lines(std::uint64_t limit) {
  if (limit == 0) return "MemoryHigh=75%\nMemoryMax=90%\n";
  // memory_limit is what areas share; the process that hands them out and files in memory come on top.
  return fmt::format("MemoryHigh={}\nMemoryMax={}\n", limit + limit / 4, limit + limit / 2);
}

std::string update_service(const Schedule& s, const std::string& unit) {
  std::vector<std::string> words = update_words(s);
  std::string out =
      fmt::format("[Unit]\nDescription={}\nDocumentation=man:blockrand(1)\nRequiresMountsFor={}\n",
                  plain_for_systemd("Blockrand: region " + s.name + ", a night"), quoted_for_systemd(s.region));
  if (!s.notify.empty()) {
    out += fmt::format("OnFailure={}-notify.service\n", unit);
    words.insert(words.end(), {"--notify", ""});  // the other unit does it, outside of this one's sandbox
  }
  out += "\n[Service]\nType=oneshot\n";
  if (!s.user.empty()) out += "User=" + s.user + "\n";
  out += "WorkingDirectory=" + plain_for_systemd(s.folder) + "\n";
  out += "ExecStart=" + exec_line(words) + "\n";
  out +=
      "# A night that hangs ends in time for the next one. A run that is ended is taken up by the next.\n"
      "TimeoutStartSec=23h\nTimeoutStopSec=2min\nKillMode=mixed\n";
  out += "Nice=10\nIOWeight=50\nLimitCORE=0\nTasksMax=512\n" + memory_lines(s.memory_limit);
  out += "\n# It reads what it may read, and writes below the region alone.\n";
  out += "ReadWritePaths=" + quoted_for_systemd(s.region) + "\n";
  for (const std::string& folder : s.written)
    out += "# [publish] of region.toml writes there.\nReadWritePaths=" + quoted_for_systemd(folder) + "\n";
  out += s.below_tmp ? "# A path of the region lies below /tmp or /var/tmp.\nPrivateTmp=no\n" : "PrivateTmp=yes\n";
  out += kSandbox;
  if (!s.hook.empty() || s.needs_network)
    out +=
        "# The hook or [publish] of region.toml, or data that are no files, may want the network.\n"
        "RestrictAddressFamilies=AF_UNIX AF_INET AF_INET6 AF_NETLINK\n";
  else
    out += "PrivateNetwork=yes\nRestrictAddressFamilies=AF_UNIX\nIPAddressDeny=any\nPrivateUsers=yes\n";
  return out;
}

std::string notify_service(const Schedule& s, const std::string& unit) {
  std::string out = fmt::format("[Unit]\nDescription={}\n\n[Service]\nType=oneshot\n",
                                plain_for_systemd("Blockrand: region " + s.name + ", tells of a night with a problem"));
  if (!s.user.empty()) out += "User=" + s.user + "\n";
  out += "WorkingDirectory=" + plain_for_systemd(s.folder) + "\n";
  out += "Environment=" + quoted_for_systemd("BLOCKRAND_REGION=" + s.region) + "\n";
  out += "Environment=BLOCKRAND_STATE=failed\n";
  out += "Environment=" +
         quoted_for_systemd("BLOCKRAND_REASON=the run ended without a word: see journalctl -u " + unit + ".service") +
         "\n# What the run itself said, where it could.\n";
  out += "EnvironmentFile=-" + plain_for_systemd(as_pattern(s.region + "/log/last_problem.env")) + "\n";
  return out + "ExecStart=" + exec_line({"/bin/sh", "-c", s.notify}) + "\n";
}

}  // namespace

std::vector<ScheduleFile> systemd_files(const Schedule& s) {
  const std::string unit = "blockrand-" + unit_name(s.name);
  std::vector<ScheduleFile> files;
  files.push_back({unit + ".service", update_service(s, unit)});
  files.push_back({unit + ".timer",
                   fmt::format("[Unit]\nDescription={}\n\n[Timer]\n"
                               "OnCalendar=*-*-* {:02}:{:02}:00\n"
                               "# A night that was missed is made up for.\nPersistent=true\n"
                               "RandomizedDelaySec=10min\nFixedRandomDelay=true\n\n"
                               "[Install]\nWantedBy=timers.target\n",
                               plain_for_systemd("Blockrand: region " + s.name + ", every night"), s.hour, s.minute)});
  if (!s.notify.empty()) files.push_back({unit + "-notify.service", notify_service(s, unit)});
  return files;
}

std::vector<ScheduleFile> cron_files(const Schedule& s) {
  std::vector<std::string> words = update_words(s);
  words.emplace_back("--quiet");
  if (s.notify_given && !s.notify.empty()) words.insert(words.end(), {"--notify", s.notify});
  std::string command = "cd " + quoted_for_sh(s.folder) + " && exec";
  for (const std::string& word : words) command += " " + quoted_for_sh(word);
  std::string out =
      "# blockrand: a region every night. Add this to a crontab (crontab -e) of a user who may write the region.\n"
      "# Exit codes: 0 published or up to date, 2 data that cannot be read, 3 published data are too old, 4 a full "
      "disk,\n"
      "# 5 refused by a gate; 1 wrong usage, or another run is at work. The region has its own lock: nights cannot "
      "overlap.\n"
      "# cron mails warnings and errors, and nothing else is written: name who gets them.\n"
      "#MAILTO=you@example.org\n"
      "# A night in which the machine is off is missed; what is new comes with the next one.\n";
  out += fmt::format("{} {} * * * {}\n", s.minute, s.hour, cron_command(command));
  return {{"blockrand-" + unit_name(s.name) + ".crontab", out}};
}

}  // namespace blockrand::cli
