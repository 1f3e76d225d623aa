#include "tools/view/server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <cstdio>
#include <set>
#include <stdexcept>

#include "monitor/app/print.hpp"
#include "tools/view/metrics_relay.hpp"
#include "tools/view/protocol.hpp"
#include "tools/view/server_state.hpp"
#include "tools/view/viewer.hpp"

namespace clearance::view {
namespace {

using HttpRequest = http::request<http::empty_body>;

constexpr auto kPatience = std::chrono::seconds(30);
constexpr auto kPause = std::chrono::milliseconds(200);  // after a connection was not accepted
constexpr std::size_t kMostRequestBytes = 1 << 16;
constexpr std::size_t kMostTold = 32;  // different messages on stderr

// One HTTP connection, until it becomes a viewer.
class Visitor : public std::enable_shared_from_this<Visitor> {
 public:
  Visitor(tcp::socket socket, ServerState& server) : stream_(std::move(socket)), server_(server) {}

  void read() {
    parser_.emplace();
    parser_->header_limit(kMostRequestBytes);
    stream_.expires_after(kPatience);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](Error error, std::size_t) {
                       if (!error) self->answer();
                     });
  }

 private:
  void answer() {
    const HttpRequest request = parser_->release();
    if (const std::string refusal = refusal_of(request); !refusal.empty()) {
      server_.tell_once(refusal);
      return respond(request, http::status::forbidden, "text/plain; charset=utf-8",
                     fmt::format("clearance-view: {}\n", refusal));
    }
    if (websocket::is_upgrade(request)) {
      stream_.expires_never();
      std::make_shared<Viewer>(stream_.release_socket(), server_)->accept(request);
      return;
    }
    serve(request);
  }

  std::string refusal_of(const HttpRequest& request) {
    Error error;
    Asked asked{.hosts = {}, .origins = {}, .reached = stream_.socket().local_endpoint(error)};
    if (error) return error.message();
    for (const auto& field : request) {
      if (field.name() == http::field::host) asked.hosts.emplace_back(field.value());
      if (field.name() == http::field::origin) asked.origins.emplace_back(field.value());
    }
    return server_.hosts.refusal_of(asked);
  }

  void serve(const HttpRequest& request) {
    const std::string target(request.target());
    Resource found;
    if (request.method() == http::verb::get) {
      const std::size_t end = std::min(target.find('?'), target.size());
      if (!server_.content.metrics.empty() && target.substr(0, end) == "/metrics")
        return relay(request);
      found = server_.content.get(target.substr(0, end),
                                  target.substr(std::min(end + 1, target.size())));
    }
    if (found.body) return respond(request, http::status::ok, found.type, *found.body);
    respond(request, http::status::not_found, "text/plain", "There is no such page here.\n");
  }

  void relay(const HttpRequest& request) {
    relay_metrics(server_.context, server_.content.metrics,
                  [self = shared_from_this(), request](RelayedMetrics metrics) {
                    self->respond(request, http::int_to_status(metrics.status), metrics.type,
                                  std::move(metrics.body));
                  });
  }

  // Other servers' pages may neither embed what is sent nor show it in a frame.
  void respond(const HttpRequest& request, http::status status, const std::string& type,
               std::string body) {
    response_ = {status, request.version()};
    response_.set(http::field::content_type, type);
    response_.set(http::field::cache_control, "no-cache");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    response_.set("Content-Security-Policy", "frame-ancestors 'self'");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.body() = std::move(body);
    response_.keep_alive(request.keep_alive());
    response_.prepare_payload();
    http::async_write(stream_, response_, [self = shared_from_this()](Error error, std::size_t) {
      if (error) return;
      if (self->response_.keep_alive()) return self->read();
      Error ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  beast::tcp_stream stream_;
  ServerState& server_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  http::response<http::string_body> response_;
};

}  // namespace

Server::Server(const std::string& host, std::uint16_t port, const std::vector<std::string>& allowed,
               Content content)
    : state_(std::make_unique<ServerState>(std::move(content), AllowedHosts(host, allowed))) {
  try {
    tcp::resolver resolver(state_->context);
    const tcp::endpoint endpoint = *resolver.resolve(host, std::to_string(port)).begin();
    state_->acceptor.open(endpoint.protocol());
    state_->acceptor.set_option(asio::socket_base::reuse_address(true));
    state_->acceptor.bind(endpoint);
    state_->acceptor.listen();
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(
        fmt::format("cannot listen on {} port {}: {}", host, port, error.code().message()));
  }
  const tcp::endpoint local = state_->acceptor.local_endpoint();
  const bool is_v6_address = host.find(':') != std::string::npos;
  const std::string shown = is_v6_address ? fmt::format("[{}]", host) : host;
  state_->address = fmt::format("http://{}:{}/", shown, local.port());
  state_->session = std::to_string(std::chrono::system_clock::now().time_since_epoch().count());
  state_->accept();
}

Server::~Server() = default;

// A connection that cannot be accepted waits, and the acceptor would fail again at once: it pauses.
void ServerState::accept() {
  acceptor.async_accept([this](Error error, tcp::socket socket) {
    if (!acceptor.is_open()) return;
    if (!error) {
      std::make_shared<Visitor>(std::move(socket), *this)->read();
    } else if (error != asio::error::connection_aborted) {
      tell_once(fmt::format("cannot accept a connection: {}; it waits until others have ended",
                            error.message()));
      pause.expires_after(kPause);
      return pause.async_wait([this](Error) { accept(); });
    }
    accept();
  });
}

void ServerState::tell_once(const std::string& line) {
  if (told.size() < kMostTold && told.insert(line).second) {
    print(stderr, "clearance-view: {}\n", line);
  }
}

const std::string& Server::address() const noexcept { return state_->address; }
std::size_t Server::viewers() const noexcept { return state_->viewers.size(); }
bool Server::is_wanted(ChannelId channel) const {
  return std::ranges::any_of(state_->viewers,
                             [=](const Viewer* viewer) { return viewer->subscribed(channel); });
}

void Server::publish(const Message& message) {
  state_->latest[{message.channel, message.key}] = message;
  for (Viewer* const viewer : std::set(state_->viewers)) viewer->send(message);
}

void Server::forget(ChannelId channel) {
  std::erase_if(state_->latest, [=](const auto& entry) { return entry.first.first == channel; });
}

void Server::set_time(std::int64_t ns) {
  for (Viewer* const viewer : std::set(state_->viewers)) viewer->send_time(ns);
}

void Server::set_status(const std::string& id, int level, const std::string& text) {
  const std::string sent = status(id, level, text);
  if (const auto known = state_->statuses.find(id);
      text.empty() ? known == state_->statuses.end()
                   : known != state_->statuses.end() && known->second == sent) {
    return;
  }
  if (text.empty()) {
    state_->statuses.erase(id);
  } else {
    state_->statuses[id] = sent;
  }
  for (Viewer* const viewer : std::set(state_->viewers)) viewer->send_text(sent);
}

void Server::parameters_changed() {
  const std::string values = parameter_values(state_->content.parameters(), {});
  for (Viewer* const viewer : std::set(state_->viewers)) {
    if (viewer->wants_parameters()) viewer->send_text(values);
  }
}

void Server::run_for(std::int64_t ns) {
  state_->context.restart();
  state_->context.run_for(std::chrono::nanoseconds(ns));
}

}  // namespace clearance::view
