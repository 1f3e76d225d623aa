// A viewer connected by WebSocket, and what it has subscribed to.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string>

#include "tools/view/protocol.hpp"
#include "tools/view/server_state.hpp"

namespace clearance::view {

// One WebSocket. It lives while an operation of it is in progress.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(tcp::socket socket, ServerState& server) : socket_(std::move(socket)), server_(server) {}
  ~Viewer() { server_.viewers.erase(this); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  void accept(const http::request<http::empty_body>& request);
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

}  // namespace clearance::view
