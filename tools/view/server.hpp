// Serves the page and its data over HTTP, and messages over WebSocket, on one port.
//
// One thread, that of whoever calls run_for(): nothing here waits for a viewer. A viewer that reads
// slowly is sent fewer messages (outbox.hpp), one that does not read at all is dropped.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/view/outbox.hpp"

namespace clearance::view {

// What a GET of a path, with what stands behind its "?", finds; `type` is the Content-Type.
struct Resource {
  std::string type;
  std::shared_ptr<const std::string> body;  // null: there is none
};

// What the server serves and whom it asks.
struct Content {
  std::string name;  // of the cell
  std::vector<Channel> channels;
  std::function<Resource(const std::string& path, const std::string& query)> get;
  std::function<nlohmann::json()> parameters;  // an array of {name, value}
  std::function<void(const std::string& name, const nlohmann::json& value)> set_parameter;
};

struct ServerState;

class Server {
 public:
  // Listens at once; port 0 takes a free one. Throws std::runtime_error with the address and the
  // system's reason when it cannot.
  Server(const std::string& host, std::uint16_t port, Content content);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // "http://127.0.0.1:8080/"
  [[nodiscard]] const std::string& address() const noexcept;
  // Those that are connected by WebSocket.
  [[nodiscard]] std::size_t viewers() const noexcept;

  // Whether any of them has subscribed to this channel.
  [[nodiscard]] bool is_wanted(ChannelId channel) const;

  // Keeps the message for viewers that come later, and sends it to all that have subscribed.
  void publish(const Message& message);
  // Viewers that come later are not sent what was published on this channel.
  void forget(ChannelId channel);
  void set_time(std::int64_t ns);
  // Shown until it is replaced or, by an empty text, taken back.
  void set_status(const std::string& id, int level, const std::string& text);
  // Tells everyone who has subscribed to parameters.
  void parameters_changed();

  void run_for(std::int64_t ns);

 private:
  std::unique_ptr<ServerState> state_;
};

}  // namespace clearance::view
