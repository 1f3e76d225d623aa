#include "tools/view/server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <set>
#include <stdexcept>

#include "tools/view/protocol.hpp"

namespace clearance::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Error = beast::error_code;
using HttpRequest = http::request<http::empty_body>;

constexpr auto kPatience = std::chrono::seconds(30);
constexpr std::size_t kMostRequestBytes = 1 << 16;
// The kernel may hold about two frames of a large cell for a viewer, so that a slow viewer does not
// see old ones.
constexpr int kSendBuffer = 1 << 18;

}  // namespace

class Viewer;

struct ServerState {
  explicit ServerState(Content the_content) : content(std::move(the_content)) {}

  Content content;
  std::string address, session;
  std::set<Viewer*> viewers;
  std::map<std::pair<ChannelId, std::uint32_t>, Message> latest;
  std::map<std::string, std::string> statuses;  // by id: the JSON that is sent
  // These members are last, so that they are destroyed first: pending operations end with the
  // context, and they use the members above.
  asio::io_context context{1};
  tcp::acceptor acceptor{context};

  void accept();
};

// One WebSocket. It lives while an operation of it is under way.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(tcp::socket socket, ServerState& server) : socket_(std::move(socket)), server_(server) {}
  ~Viewer() { server_.viewers.erase(this); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  void accept(const HttpRequest& request);
  void send(const Message& message) {
    if (!subscribed(message.channel)) return;
    outbox_.add(message);
    write_next();
  }
  void send_time(std::int64_t ns) {
    outbox_.set_time(ns);
    write_next();
  }
  void send_text(std::string text) {
    if (outbox_.add_text(std::move(text))) return write_next();
    Error ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
  }
  [[nodiscard]] bool wants_parameters() const noexcept { return wants_parameters_; }
  [[nodiscard]] bool subscribed(ChannelId channel) const {
    return std::ranges::any_of(subscriptions_,
                               [=](const auto& entry) { return entry.second == channel; });
  }

 private:
  void greet();
  void read();
  void answer(const Request& request);
  void subscribe(const Request& request);
  void set_parameters(const Request& request);
  void write_next();
  void write(bool is_text, std::size_t begin);

  websocket::stream<beast::tcp_stream> socket_;
  ServerState& server_;
  beast::flat_buffer received_;
  Outbox outbox_;
  std::map<std::uint32_t, ChannelId> subscriptions_;  // by the client's id
  bool open_ = false, writing_ = false, wants_parameters_ = false;
  // The message being written; it must stay until the end of the write.
  std::string text_;
  std::array<std::byte, kMessageHeader> header_{};
  std::array<std::byte, kTimeMessage> time_{};
  Bytes payload_;
};

void Viewer::accept(const HttpRequest& request) {
  socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
  socket_.read_message_max(kMostRequestBytes);
  const std::string asked(request[http::field::sec_websocket_protocol]);
  for (const std::string_view known : kSubprotocols) {
    if (asked.find(known) == std::string::npos) continue;
    socket_.set_option(websocket::stream_base::decorator([known](websocket::response_type& reply) {
      reply.set(http::field::sec_websocket_protocol, std::string(known));
    }));
    break;
  }
  socket_.async_accept(request, [self = shared_from_this()](Error error) {
    if (!error) self->greet();
  });
}

void Viewer::greet() {
  open_ = true;
  Error ignored;
  auto& stream = beast::get_lowest_layer(socket_).socket();
  stream.set_option(tcp::no_delay(true), ignored);
  stream.set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  server_.viewers.insert(this);
  send_text(server_info(server_.content.name, server_.session));
  send_text(advertise(server_.content.channels));
  for (const auto& [id, text] : server_.statuses) send_text(text);
  read();
}

void Viewer::read() {
  socket_.async_read(received_, [self = shared_from_this()](Error error, std::size_t) {
    if (error) {
      self->open_ = false;
      self->server_.viewers.erase(self.get());
      return;
    }
    const auto bytes = self->received_.data();
    self->answer(parse_request({static_cast<const char*>(bytes.data()), self->received_.size()}));
    self->received_.clear();
    self->read();
  });
}

void Viewer::answer(const Request& request) {
  switch (request.kind) {
    case Request::Kind::kIgnored:
      return;
    case Request::Kind::kSubscribe:
      return subscribe(request);
    case Request::Kind::kUnsubscribe:
      for (const std::uint32_t id : request.ids) subscriptions_.erase(id);
      return;
    case Request::Kind::kGetParameters:
      return send_text(parameter_values(server_.content.parameters(), request.id));
    case Request::Kind::kSetParameters:
      return set_parameters(request);
    case Request::Kind::kSubscribeParameters:
      wants_parameters_ = true;
      return;
  }
}

// The latest message of each key follows at once, since some topics are written only once.
void Viewer::subscribe(const Request& request) {
  constexpr std::size_t kMostSubscriptions = 256;
  for (const auto& [id, channel] : request.subscriptions) {
    if (channel >= server_.content.channels.size()) continue;
    if (subscriptions_.size() >= kMostSubscriptions) return;
    subscriptions_[id] = channel;
    for (const auto& [place, message] : server_.latest) {
      if (place.first == channel) outbox_.add(message);
    }
  }
  write_next();
}

void Viewer::set_parameters(const Request& request) {
  for (const auto& parameter : request.parameters) {
    if (!parameter.is_object() || !parameter.contains("name") || !parameter["name"].is_string())
      continue;
    server_.content.set_parameter(parameter["name"], parameter.value("value", nlohmann::json{}));
  }
  if (!request.id.empty()) {
    send_text(parameter_values(server_.content.parameters(), request.id));
  }
}

// One message is under way at a time; later ones wait in the outbox or replace others there.
void Viewer::write_next() {
  if (writing_ || !open_) return;
  if (auto text = outbox_.take_text()) {
    text_ = std::move(*text);
    return write(true, 0);
  }
  if (const auto time_ns = outbox_.take_time()) {
    time_ = time_message(*time_ns);
    return write(false, 0);
  }
  while (const auto message = outbox_.take_message()) {
    const auto subscription = std::ranges::find_if(
        subscriptions_, [&](const auto& entry) { return entry.second == message->channel; });
    if (subscription == subscriptions_.end()) continue;
    header_ = message_header(subscription->first, message->time_ns);
    payload_ = message->payload;
    return write(false, 1);
  }
}

// `begin` 0: a text or the time; 1: a message.
void Viewer::write(bool is_text, std::size_t begin) {
  writing_ = true;
  socket_.text(is_text);
  std::array<asio::const_buffer, 2> buffers;
  if (is_text) {
    buffers[0] = asio::buffer(text_);
  } else if (begin == 0) {
    buffers[0] = asio::buffer(time_.data(), time_.size());
  } else {
    buffers = {asio::buffer(header_.data(), header_.size()),
               asio::buffer(payload_->data(), payload_->size())};
  }
  socket_.async_write(buffers, [self = shared_from_this()](Error error, std::size_t) {
    self->writing_ = false;
    self->payload_.reset();
    if (!error) self->write_next();
  });
}

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
    if (websocket::is_upgrade(request)) {
      stream_.expires_never();
      std::make_shared<Viewer>(stream_.release_socket(), server_)->accept(request);
      return;
    }
    respond(request);
  }

  void respond(const HttpRequest& request) {
    const std::string target(request.target());
    Resource found;
    if (request.method() == http::verb::get) {
      const std::size_t end = std::min(target.find('?'), target.size());
      found = server_.content.get(target.substr(0, end),
                                  target.substr(std::min(end + 1, target.size())));
    }
    response_ = {found.body ? http::status::ok : http::status::not_found, request.version()};
    response_.set(http::field::content_type, found.body ? found.type : "text/plain");
    response_.set(http::field::cache_control, "no-cache");
    response_.body() = found.body ? *found.body : "There is no such page here.\n";
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

Server::Server(const std::string& host, std::uint16_t port, Content content)
    : state_(std::make_unique<ServerState>(std::move(content))) {
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
  const std::string shown = local.address().is_v6() ? fmt::format("[{}]", host) : host;
  state_->address = fmt::format("http://{}:{}/", shown, local.port());
  state_->session = std::to_string(std::chrono::system_clock::now().time_since_epoch().count());
  state_->accept();
}

Server::~Server() = default;

void ServerState::accept() {
  acceptor.async_accept([this](Error error, tcp::socket socket) {
    if (!acceptor.is_open()) return;
    if (!error) {
      std::make_shared<Visitor>(std::move(socket), *this)->read();
    }
    accept();
  });
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
