#include "pipeline/view/server.h"

#include <fmt/format.h>
#include <httplib.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "pipeline/base/error.h"

namespace blockrand::view {
namespace {

constexpr std::size_t kPiece = 1 << 20;  // bytes of a file in memory at a time
constexpr std::size_t kThreads = 32;     // a browser opens six connections, and holds them for a while

/// The page loads nothing from elsewhere, and no page elsewhere may frame or read it. three.js makes pictures from blobs and its
/// decoder is WebAssembly.
constexpr const char* kPolicy =
    "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; img-src 'self' data: "
    "blob:; "
    "connect-src 'self' data: blob:; worker-src 'self' blob:; base-uri 'none'; form-action 'none'; frame-ancestors "
    "'none'";

}  // namespace

struct Server::State {
  explicit State(const Site& s) : site(s) {}

  /// Whether who asks is a page of this server, or a user.
  bool is_ours(const httplib::Request& request) const {
    const std::string numbers = fmt::format("127.0.0.1:{}", port), name = fmt::format("localhost:{}", port);
    const std::string host = request.get_header_value("Host");
    if (request.get_header_value_count("Host") != 1 || (host != numbers && host != name)) return false;
    if (request.has_header("Origin")) {
      const std::string origin = request.get_header_value("Origin");
      if (origin != "http://" + numbers && origin != "http://" + name) return false;
    }
    for (const char* name : {"Origin", "Sec-Fetch-Site"})
      if (request.get_header_value_count(name) > 1) return false;
    const std::string from = request.get_header_value("Sec-Fetch-Site");
    return from.empty() || from == "same-origin" || from == "none";
  }

  void answer(const httplib::Request& request, httplib::Response& response) const {
    std::optional<Resource> found;
    try {
      found = site.find(std::string_view(request.path).substr(1));
    } catch (const std::exception& error) {
      response.status = 500;
      response.set_content(std::string(error.what()) + "\n", "text/plain; charset=utf-8");
      return;
    }
    if (!found) {
      response.status = 404;
      response.set_content("There is no such file here.\n", "text/plain; charset=utf-8");
      return;
    }
    if (!found->file) {
      response.set_content(std::move(found->bytes), found->type);
      return;
    }
    const std::string version = '"' + found->file->version() + '"';
    response.set_header("ETag", version);
    if (request.get_header_value("If-None-Match") == version) {
      response.status = 304;
      return;
    }
    if (found->file->size() == 0) {
      response.set_content("", found->type);
      return;
    }
    response.set_content_provider(
        found->file->size(), found->type,
        [file = found->file](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
          const std::optional<std::string> piece = file->read(offset, std::min(length, kPiece));
          return piece && !piece->empty() && sink.write(piece->data(), piece->size());
        });
  }

  const Site& site;
  httplib::Server server;
  int port = 0;
  std::atomic<bool> ended = false;
};

Server::Server(const Site& site) : state_(std::make_unique<State>(site)) {
  httplib::Server& server = state_->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  // The library's own choice lets a second server take the same port, and half of what is asked.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_payload_max_length(1024);
  server.set_keep_alive_max_count(1000);
  server.set_keep_alive_timeout(2);  // s
  server.set_read_timeout(10);
  server.set_write_timeout(30);
  server.set_default_headers({{"Content-Security-Policy", kPolicy},
                              {"X-Content-Type-Options", "nosniff"},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Referrer-Policy", "no-referrer"},
                              {"Cache-Control", "no-cache"}});
  server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
    if (!state_->is_ours(request)) {
      response.status = 403;
      response.set_content("Only pages of this server are answered.\n", "text/plain; charset=utf-8");
      return httplib::Server::HandlerResponse::Handled;
    }
    if (request.method != "GET" && request.method != "HEAD") {
      response.status = 405;
      response.set_header("Allow", "GET, HEAD");
      return httplib::Server::HandlerResponse::Handled;
    }
    if (!request.path.starts_with('/')) {
      response.status = 400;
      return httplib::Server::HandlerResponse::Handled;
    }
    // The library answers a range beyond the end with fewer bytes than it announces. The page asks for whole files, and who may have
    // a part may be given all of it (RFC 9110, section 14.2).
    const_cast<httplib::Request&>(request).ranges.clear();
    state_->answer(request, response);
    return httplib::Server::HandlerResponse::Handled;
  });
}

Server::~Server() = default;

int Server::bind(int port) {
  constexpr const char* kHost = "127.0.0.1";
  if (port == 0) {
    const int any = state_->server.bind_to_any_port(kHost);
    return state_->port = any < 0 ? 0 : any;
  }
  return state_->port = state_->server.bind_to_port(kHost, port) ? port : 0;
}

void Server::run() {
  state_->server.listen_after_bind();
  state_->ended = true;
}

void Server::stop() {
  // The library forgets a stop that comes before it listens.
  using namespace std::chrono_literals;
  while (!state_->ended && !state_->server.is_running()) std::this_thread::sleep_for(1ms);
  state_->server.stop();
}

}  // namespace blockrand::view
