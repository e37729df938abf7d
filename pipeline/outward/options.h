// Where a build is sent when it is published outward, and how.
#pragma once

#include <string>

#include "pipeline/base/option_table.h"

namespace blockrand::outward {

struct PublishOptions {
  std::string command;               ///< run by /bin/sh for each list of files; empty: none
  std::string web_root;              ///< web root, written by the program itself; empty: none
  std::string target = "web";        ///< name of what is sent to: each has a state of its own
  double keep_deleted = 24;          ///< hours that files stay after no tileset names them any more
  int batch = 1000;                  ///< files of one call of the command at most
  std::string variants = "none";     ///< "gzip": smaller variants lie beside
  bool resend = false;               ///< everything is sent again, whatever is said to be there
  std::string archive;               ///< .3tz file that the tiles are packed into; empty: none
  std::string postgis;               ///< "PG:dbname=…"; empty: none
  std::string schema = "blockrand";  ///< of the database, that tables lie in

  /// Whether there is anything to do.
  bool any() const { return !command.empty() || !web_root.empty() || !archive.empty() || !postgis.empty(); }
};

/// Section [publish].
base::OptionTable<PublishOptions> publish_options();

}  // namespace blockrand::outward
