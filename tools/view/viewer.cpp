#include "tools/view/viewer.hpp"

#include <utility>

namespace clearance::view {
namespace {

constexpr std::size_t kMostMessageBytes = 1 << 16;
// The kernel may hold about two frames of a large cell for a viewer, so that a slow viewer does not
// see old ones.
constexpr int kSendBuffer = 1 << 18;

}  // namespace

void Viewer::accept(const http::request<http::empty_body>& request) {
  socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
  socket_.read_message_max(kMostMessageBytes);
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

// One message is in progress at a time; later ones wait in the outbox or replace others there.
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

}  // namespace clearance::view
