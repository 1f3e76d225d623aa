// Collects the lines of the log while a test runs.
#pragma once

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace clearance::test {

// Collects the lines that the daemon's threads log meanwhile.
class Logged : public spdlog::sinks::base_sink<std::mutex> {
 public:
  [[nodiscard]] bool has(std::string_view text) {
    const std::lock_guard lock(mutex_);
    return text_.find(text) != std::string::npos;
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

 private:
  std::shared_ptr<spdlog::logger> before_;
};

}  // namespace clearance::test
