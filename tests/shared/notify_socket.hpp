// A service manager's socket, as sd_notify(3) describes it.
#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <optional>
#include <string>

#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {

class NotifySocket {
 public:
  NotifySocket() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path().c_str(), sizeof address.sun_path - 1);
    const auto* const bound = reinterpret_cast<const sockaddr*>(&address);
    EXPECT_EQ(::bind(socket_, bound, sizeof address), 0) << path();
  }
  ~NotifySocket() { ::close(socket_); }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  [[nodiscard]] std::string path() const { return (folder_ / "notify").string(); }

  // The next message in the order of sending. Nothing if none has come within this time.
  std::optional<std::string> next(std::chrono::milliseconds limit = std::chrono::seconds(60)) {
    const timeval time{.tv_sec = limit.count() / 1000,
                       .tv_usec = std::max<suseconds_t>(1, limit.count() % 1000 * 1000)};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &time, sizeof time);
    char text[4096];
    const ssize_t length = ::recv(socket_, text, sizeof text, 0);
    if (length < 0) return std::nullopt;
    return std::string(text, static_cast<std::size_t>(length));
  }
  // Drops messages up to the first one that contains `part`, and returns that one.
  std::optional<std::string> until(const std::string& part) {
    for (;;) {
      auto message = next();
      if (!message || message->find(part) != std::string::npos) return message;
    }
  }

 private:
  ScratchFolder folder_;
  int socket_;
};

}  // namespace clearance::test
