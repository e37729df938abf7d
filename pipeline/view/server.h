// A site on this machine alone: what `blockrand view` serves to a browser.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "pipeline/view/site.h"

namespace blockrand::view {

/// Answers GET and HEAD on 127.0.0.1. Refused (403) is who asks under another name than that or localhost (a page elsewhere whose
/// name leads here), and what a page from elsewhere asks for (Origin, Sec-Fetch-Site).
class Server {
 public:
  /// \param site  outlives the server
  explicit Server(const Site& site);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// \param port  0: any that is free
  /// \returns the port; 0 where it is taken
  int bind(int port);
  /// Serves until stop(). After bind().
  void run();
  /// From any thread, while run() runs or is about to.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace blockrand::view
