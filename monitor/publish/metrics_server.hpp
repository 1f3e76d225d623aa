// Answers GET /metrics on a Unix socket, over HTTP/1.1.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace clearance {

// A thread of its own serves the last text that was published. A client that is slow or does not
// read delays no other client, and is dropped after a second.
class MetricsServer {
 public:
  // Listens at once; only the owner and the group of the process may connect. A socket that a
  // program left behind is replaced. Throws std::runtime_error with the path and the reason when
  // the path is another file, when a running program listens there, or when the system refuses.
  explicit MetricsServer(const std::filesystem::path& socket);
  ~MetricsServer();  // removes the socket
  MetricsServer(const MetricsServer&) = delete;
  MetricsServer& operator=(const MetricsServer&) = delete;

  // Any thread. Before the first text, the answer is 503.
  void publish(std::string text);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace clearance
