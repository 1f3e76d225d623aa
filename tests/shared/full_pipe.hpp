// A pipe that no process reads and whose buffer is already full.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>

namespace clearance::test {

class FullPipe {
 public:
  FullPipe() {
    [[maybe_unused]] const int made = pipe2(ends_.data(), O_CLOEXEC);
    fcntl(ends_[1], F_SETFL, O_NONBLOCK);
    const std::string filler(4096, '.');
    while (::write(ends_[1], filler.data(), filler.size()) > 0) {
    }
    fcntl(ends_[1], F_SETFL, 0);  // a writer now waits for a reader
  }
  ~FullPipe() {
    for (const int end : ends_) close(end);
  }
  FullPipe(const FullPipe&) = delete;
  FullPipe& operator=(const FullPipe&) = delete;

  [[nodiscard]] int in() const noexcept { return ends_[1]; }

  // Reads until nothing arrives for `quiet_ms`. Returns what was read without the bytes that filled
  // the pipe.
  std::string read(int quiet_ms) {
    std::string text;
    std::array<char, 4096> bytes;
    pollfd readable{.fd = ends_[0], .events = POLLIN, .revents = 0};
    while (::poll(&readable, 1, quiet_ms) > 0) {
      const ssize_t count = ::read(ends_[0], bytes.data(), bytes.size());
      if (count <= 0) break;
      text.append(bytes.data(), static_cast<std::size_t>(count));
    }
    return text.substr(std::min(text.size(), text.find_first_not_of('.')));
  }

 private:
  std::array<int, 2> ends_{};
};

}  // namespace clearance::test
