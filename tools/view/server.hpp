// Serves the page and its data over HTTP, and messages over WebSocket, on one port.
//
// The server works in the one thread that calls run_for() and never waits for a viewer. A slow
// viewer gets fewer messages (outbox.hpp); one that does not read at all is dropped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/view/outbox.hpp"

namespace clearance::view {

// The answer to a GET of a path, which may include a query after "?"; `type` is the Content-Type.
struct Resource {
  std::string type;
  std::shared_ptr<const std::string> body;  // null: there is none
};

// The content of the server, and its callbacks.
struct Content {
  std::string name;  // the cell's name
  std::vector<Channel> channels;
  std::function<Resource(const std::string& path, const std::string& query)> get;
  std::function<nlohmann::json()> parameters;  // an array of {name, value}
  std::function<void(const std::string& name, const nlohmann::json& value)> set_parameter;
  std::filesystem::path metrics = {};  // the daemon's socket, for /metrics; empty: there is none
};

struct ServerState;

class Server {
 public:
  // Listens at once; port 0 takes a free one. `allowed`: hosts and origins beside its own
  // (allowed_hosts.hpp). Throws std::runtime_error with the address and the system's reason.
  Server(const std::string& host, std::uint16_t port, const std::vector<std::string>& allowed,
         Content content);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // "http://127.0.0.1:8080/"
  [[nodiscard]] const std::string& address() const noexcept;
  // The number of viewers connected by WebSocket.
  [[nodiscard]] std::size_t viewers() const noexcept;

  // True when a viewer has subscribed to this channel.
  [[nodiscard]] bool is_wanted(ChannelId channel) const;

  // Keeps the message for later viewers, and sends it to all subscribers.
  void publish(const Message& message);
  // Removes the messages of this channel that were kept for later viewers.
  void forget(ChannelId channel);
  void set_time(std::int64_t ns);
  // Shows a status until it is replaced or, with an empty text, withdrawn.
  void set_status(const std::string& id, int level, const std::string& text);
  // Tells all subscribers of parameters.
  void parameters_changed();

  void run_for(std::int64_t ns);

 private:
  std::unique_ptr<ServerState> state_;
};

}  // namespace clearance::view
