// What schedulers want to be given so that a region is updated every night. Internal to this folder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace blockrand::cli {

struct Schedule {
  std::string program, region,
      folder;                 ///< absolute: the program, the region, where relative paths of region.toml begin
  std::string name;           ///< of the region: its folder's
  std::string version;        ///< of the program
  int hour = 2, minute = 30;  ///< local time
  std::string notify;         ///< command of sh for nights with a problem, or empty
  bool notify_given = false;  ///< on the command line, not in region.toml
  double max_age_hours = 0;   ///< as given on the command line; 0: what region.toml says holds
  std::string hook;           ///< of region.toml
  std::string user;           ///< systemd: under whom; empty: what systemd takes
  std::string image;          ///< kubernetes: with the program
  std::int64_t shards = 1;
  std::uint64_t memory_limit = 0;    ///< bytes, of region.toml; 0: none
  bool needs_network = false;        ///< region.toml names data that are not files
  std::vector<std::string> written;  ///< absolute: folders beside the region that [publish] writes to
  bool below_tmp = false;            ///< the region, or something that region.toml names, lies below /tmp or /var/tmp
  std::string settings;              ///< region.toml itself
};

struct ScheduleFile {
  std::string name, text;
};

/// A service and a timer, and a second service that runs `notify`. \throws base::UsageError  a path that cannot be written there
std::vector<ScheduleFile> systemd_files(const Schedule& schedule);
/// A crontab. \throws base::UsageError  as above
std::vector<ScheduleFile> cron_files(const Schedule& schedule);
/// A script that submits the jobs of one night.
std::vector<ScheduleFile> slurm_files(const Schedule& schedule);
/// ConfigMap, PersistentVolumeClaim and CronJob. \throws base::UsageError  region.toml cannot be a ConfigMap; `notify` with shards
std::vector<ScheduleFile> kubernetes_files(const Schedule& schedule);

}  // namespace blockrand::cli
