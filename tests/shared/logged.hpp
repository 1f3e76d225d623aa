// Keeps what the code under test logs.
#pragma once

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace clearance::test {

class Logged : public spdlog::sinks::base_sink<std::mutex> {
 public:
  [[nodiscard]] bool has(std::string_view text) { return count(text) > 0; }
  // Returns how often the text occurs.
  [[nodiscard]] std::size_t count(std::string_view text) {
    const std::lock_guard lock(mutex_);
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text_.find(text, at)) != std::string::npos; at += text.size()) {
      ++count;
    }
    return count;
  }
  // Returns all lines.
  [[nodiscard]] std::string text() {
    const std::lock_guard lock(mutex_);
    return text_;
  }

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    text_.append(message.payload.data(), message.payload.size()).append("\n");
  }
  void flush_() override {}

  std::string text_;
};

// Replaces the default logger temporarily.
class LoggedTo {
 public:
  explicit LoggedTo(const std::shared_ptr<Logged>& sink) : before_(spdlog::default_logger()) {
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink));
  }
  ~LoggedTo() { spdlog::set_default_logger(before_); }
  LoggedTo(const LoggedTo&) = delete;
  LoggedTo& operator=(const LoggedTo&) = delete;

 private:
  std::shared_ptr<spdlog::logger> before_;
};

}  // namespace clearance::test
