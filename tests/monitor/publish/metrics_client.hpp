// A client of the metrics that knows nothing of ours: a socket, and the reader of Prometheus' own
// Python library.
#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/shared/child_process.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {

// A connection to a Unix socket; its operations give up after ten seconds.
class UnixClient {
 public:
  explicit UnixClient(const std::filesystem::path& socket)
      : fd_(::socket(AF_UNIX, SOCK_STREAM, 0)) {
    const timeval patience{10, 0};
    setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, socket.c_str(), sizeof address.sun_path - 1);
    is_connected_ =
        ::connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~UnixClient() { ::close(fd_); }
  UnixClient(const UnixClient&) = delete;
  UnixClient& operator=(const UnixClient&) = delete;

  [[nodiscard]] bool is_connected() const { return is_connected_; }
  void send(const std::string& text) { (void)::send(fd_, text.data(), text.size(), MSG_NOSIGNAL); }
  // Everything until the server closes the connection.
  [[nodiscard]] std::string rest() {
    std::string text;
    char some[4096];
    for (ssize_t n = 0; (n = ::recv(fd_, some, sizeof some, 0)) > 0;)
      text.append(some, static_cast<std::size_t>(n));
    return text;
  }

 private:
  int fd_;
  bool is_connected_ = false;
};

// The whole answer to a request, head included.
inline std::string ask(const std::filesystem::path& socket, const std::string& method,
                       const std::string& target) {
  UnixClient client(socket);
  client.send(method + " " + target + " HTTP/1.1\r\nHost: x\r\n\r\n");
  return client.rest();
}

inline std::string body_of(const std::string& answer) {
  const std::size_t head = answer.find("\r\n\r\n");
  return head == std::string::npos ? "" : answer.substr(head + 4);
}

// Samples by "NAME LABEL=VALUE ...", labels in alphabetic order.
inline std::map<std::string, double> read_metrics(const std::string& text) {
  const ScratchFolder folder;
  write_text(folder / "metrics.txt", text);
  // Debian's Python has Debian's library.
  ChildProcess reader("/usr/bin/python3",
                      {places::sources() + "/tests/monitor/publish/read_metrics.py",
                       (folder / "metrics.txt").string()});
  EXPECT_EQ(reader.wait(), 0) << reader.output();
  std::map<std::string, double> samples;
  const auto read = nlohmann::json::parse(reader.output());
  for (const auto& [key, value] : read.items()) samples[key] = std::stod(value.get<std::string>());
  return samples;
}

}  // namespace clearance::test
