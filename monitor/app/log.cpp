// stderr, since stdout belongs to results. The thread that writes may wait in write() for ever;
// then it is left behind when the program ends, with all that it uses.
#include "monitor/app/log.hpp"

#include <poll.h>
#include <pthread.h>
#include <spdlog/details/log_msg.h>
#include <spdlog/details/os.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <semaphore>
#include <string_view>
#include <thread>
#include <utility>

#include "config/text/printable.hpp"
#include "monitor/app/log_queue.hpp"

namespace clearance {
namespace {

constexpr std::size_t kQueuedLines = 1024;

// As spdlog colours them: trace, debug, info, warn, error, critical.
constexpr std::array kColours = {"\x1b[37m",        "\x1b[36m",        "\x1b[32m",
                                 "\x1b[33m\x1b[1m", "\x1b[31m\x1b[1m", "\x1b[1m\x1b[41m"};
constexpr std::string_view kPlain = "\x1b[m";

// A descriptor that somebody else made non-blocking is waited for here, too.
bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written >= 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno == EAGAIN) {
      pollfd writable{.fd = descriptor, .events = POLLOUT, .revents = 0};
      ::poll(&writable, 1, -1);
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

// What the log's thread does, and all that it uses.
class LogWriter {
 public:
  explicit LogWriter(std::string name)
      : name_(std::move(name)),
        in_colour_(spdlog::details::os::in_terminal(stderr) &&
                   spdlog::details::os::is_color_terminal()) {}

  // Any thread.
  void push(LogLine line) noexcept {
    queue_.push(std::move(line));
    ready_.release();
  }
  void close() noexcept {
    closed_ = true;
    ready_.release();
  }
  [[nodiscard]] std::uint64_t pushed() const noexcept { return queue_.pushed(); }
  [[nodiscard]] std::uint64_t written() const noexcept { return written_; }
  [[nodiscard]] bool ended() const noexcept { return ended_; }

  // The thread: until close(), and then until the queue is empty.
  void run() {
    pthread_setname_np(pthread_self(), "log");
    for (bool closed = false; !closed;) {
      ready_.acquire();
      closed = closed_;  // asked before the last look, so that nothing is left behind
      LogLine line;
      while (queue_.pop(line)) {
        note_left_out(line.left_out_before, line.time);
        if (!write(line)) queue_.leave_out(1);
        ++written_;
      }
      note_left_out(queue_.take_left_out(), std::chrono::system_clock::now());
    }
    ended_ = true;
  }

 private:
  void note_left_out(std::uint64_t count, std::chrono::system_clock::time_point time) {
    if (count == 0) return;
    const std::string text =
        fmt::format("{} lines are left out here: stderr took them too slowly", count);
    if (!write({.time = time, .level = spdlog::level::warn, .text = text})) queue_.leave_out(count);
  }

  // False: it could not be written.
  bool write(const LogLine& line) {
    const std::string text = printable(line.text);
    const spdlog::details::log_msg message(line.time, {}, name_, line.level, text);
    spdlog::memory_buf_t formatted;
    formatter_.format(message, formatted);
    std::string out(formatted.data(), formatted.size());
    if (in_colour_ && message.color_range_end > message.color_range_start) {
      out.insert(message.color_range_end, kPlain);
      out.insert(message.color_range_start, kColours[static_cast<std::size_t>(line.level)]);
    }
    return write_all(STDERR_FILENO, out);
  }

  std::string name_;
  bool in_colour_;
  spdlog::pattern_formatter formatter_{"%Y-%m-%d %H:%M:%S.%e %n %^%l%$: %v"};
  LogQueue queue_{kQueuedLines};
  std::counting_semaphore<> ready_{0};
  std::atomic<std::uint64_t> written_{0};
  std::atomic<bool> closed_{false}, ended_{false};
};

// Asks every millisecond: it is only done at the end of a program or in front of a message.
template <class Condition>
bool comes_true(Condition&& condition) {
  const auto end = std::chrono::steady_clock::now() + kLogPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

// spdlog's end of the queue. The pattern is the log's and cannot be changed.
class LogSink final : public spdlog::sinks::sink {
 public:
  explicit LogSink(const std::string& name)
      : writer_(std::make_shared<LogWriter>(name)),
        thread_([writer = writer_] { writer->run(); }) {}
  LogSink(const LogSink&) = delete;
  LogSink& operator=(const LogSink&) = delete;
  ~LogSink() override {
    writer_->close();
    if (comes_true([this] { return writer_->ended(); })) {
      thread_.join();
    } else {
      thread_.detach();
    }
  }

  void log(const spdlog::details::log_msg& message) override {
    writer_->push({.time = message.time,
                   .level = message.level,
                   .text = std::string(message.payload.data(), message.payload.size())});
  }
  void flush() override {
    comes_true([this, so_far = writer_->pushed()] { return writer_->written() >= so_far; });
  }
  void set_pattern(const std::string&) override {}
  void set_formatter(std::unique_ptr<spdlog::formatter>) override {}

 private:
  std::shared_ptr<LogWriter> writer_;
  std::thread thread_;
};

// Of the program, once it has a log.
std::weak_ptr<LogSink> the_log;

}  // namespace

void start_log(const std::string& name, const std::string& level) {
  auto sink = std::make_shared<LogSink>(name);
  the_log = sink;
  auto logger = std::make_shared<spdlog::logger>(name, std::move(sink));
  logger->set_level(spdlog::level::from_str(level));
  // spdlog's own handler prints to stderr, which may take nothing.
  logger->set_error_handler([](const std::string&) {});
  spdlog::set_default_logger(std::move(logger));
}

void drain_log() {
  if (const auto log = the_log.lock()) log->flush();
}

}  // namespace clearance
