// The log goes to stderr, since stdout belongs to results. The log's thread may wait in write() for
// ever. The program then ends without that thread and leaves its pool allocated.
//
// Logging takes spdlog's mutex for as long as it takes to move one line; the tick thread never
// logs.
#include "monitor/app/log.hpp"

#include <poll.h>
#include <pthread.h>
#include <spdlog/async_logger.h>
#include <spdlog/details/os.h>
#include <spdlog/details/thread_pool.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <deque>
#include <iterator>
#include <memory>
#include <string_view>
#include <thread>
#include <utility>

#include "config/text/printable.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/interface/mutex.hpp"

namespace clearance {
namespace {

using spdlog::details::log_msg;

constexpr std::size_t kQueuedLines = 1024;

// The colours that spdlog gives to trace, debug, info, warn, error and critical.
constexpr std::array kColours = {"\x1b[37m",        "\x1b[36m",        "\x1b[32m",
                                 "\x1b[33m\x1b[1m", "\x1b[31m\x1b[1m", "\x1b[1m\x1b[41m"};
constexpr std::string_view kPlain = "\x1b[m";

// Another process may have made the descriptor non-blocking; then poll() waits.
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

// Ignores changes of the pattern: each sink keeps the one that it was made with.
class Sink : public spdlog::sinks::sink {
  void flush() override {}
  void set_pattern(const std::string&) override {}
  void set_formatter(std::unique_ptr<spdlog::formatter>) override {}
};

// The far end of the queue. Only the log's thread calls it. spdlog's own sinks to stderr hold the
// lock of the FILE while they write. print() and exit() would then wait for that lock.
class StderrSink final : public Sink {
 public:
  explicit StderrSink(spdlog::details::thread_pool& queue)
      : queue_(queue),
        in_colour_(spdlog::details::os::in_terminal(stderr) &&
                   spdlog::details::os::is_color_terminal()) {}

  void log(const log_msg& message) override {
    note_left_out(message);
    const std::string_view text(message.payload.data(), message.payload.size());
    if (!write(message, message.level, printable(text))) ++failed_;
    ++written_;
  }
  // Any thread: lines that have left the queue, written or displaced.
  [[nodiscard]] std::uint64_t finished() const {
    const std::uint64_t written = written_;
    return written + queue_.overrun_counter();
  }

 private:
  void note_left_out(const log_msg& next) {
    const std::uint64_t left_out = queue_.overrun_counter() + failed_;
    if (left_out == told_) return;
    const std::uint64_t count = left_out - told_;
    const std::string text = fmt::format("{} {} left out here: stderr took them too slowly", count,
                                         count == 1 ? "line is" : "lines are");
    if (write(next, spdlog::level::warn, text)) told_ = left_out;
  }

  // Returns false if stderr refuses the line.
  bool write(const log_msg& event, spdlog::level::level_enum level, const std::string& text) {
    const log_msg line(event.time, {}, event.logger_name, level, text);
    spdlog::memory_buf_t formatted;
    formatter_.format(line, formatted);
    std::string out(formatted.data(), formatted.size());
    if (in_colour_ && line.color_range_end > line.color_range_start) {
      out.insert(line.color_range_end, kPlain);
      out.insert(line.color_range_start, kColours[static_cast<std::size_t>(level)]);
    }
    return write_all(STDERR_FILENO, out);
  }

  spdlog::details::thread_pool& queue_;
  bool in_colour_;
  spdlog::pattern_formatter formatter_{"%Y-%m-%d %H:%M:%S.%e %n %^%l%$: %v"};
  std::uint64_t failed_ = 0, told_ = 0;
  std::atomic<std::uint64_t> written_{0};
};

// The pool that the log's thread still uses if it hangs in write() when the program ends.
std::shared_ptr<spdlog::details::thread_pool>* left_behind = nullptr;

// The near end of the queue. It counts lines, because spdlog does not tell whether all of them are
// written.
class QueueSink final : public Sink {
 public:
  explicit QueueSink(const std::string& name)
      : queue_(std::make_shared<spdlog::details::thread_pool>(
            kQueuedLines, 1, [] { pthread_setname_np(pthread_self(), "log"); })),
        stderr_(std::make_shared<StderrSink>(*queue_)),
        logger_(std::make_shared<spdlog::async_logger>(
            name, stderr_, queue_, spdlog::async_overflow_policy::overrun_oldest)) {
    logger_->set_level(spdlog::level::trace);
    // spdlog's own handler prints to stderr, which may take nothing.
    logger_->set_error_handler([](const std::string&) {});
  }
  QueueSink(const QueueSink&) = delete;
  QueueSink& operator=(const QueueSink&) = delete;
  // The pool's destructor waits for its thread.
  ~QueueSink() override {
    if (!drain()) left_behind = new std::shared_ptr(queue_);
  }

  void log(const log_msg& message) override {
    ++posted_;
    logger_->log(message.time, message.source, message.level, message.payload);
  }
  // Polls once per millisecond, which suffices: it is called only at the end of a program and
  // before a message.
  bool drain() const {
    const auto end = std::chrono::steady_clock::now() + kLogPatience;
    const std::uint64_t posted = posted_;
    while (stderr_->finished() < posted) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }

 private:
  std::atomic<std::uint64_t> posted_{0};
  std::shared_ptr<spdlog::details::thread_pool> queue_;
  std::shared_ptr<StderrSink> stderr_;
  std::shared_ptr<spdlog::async_logger> logger_;
};

// By LogLevel.
constexpr spdlog::level::level_enum kLevels[] = {spdlog::level::info, spdlog::level::warn,
                                                 spdlog::level::err};

// Lines for kept_lines().
struct KeptLines {
  Mutex mutex;
  GUARDED_BY(mutex) std::size_t most = 0;
  GUARDED_BY(mutex) std::string name = "clearance";
  GUARDED_BY(mutex) std::deque<LoggedLine> lines;
};
KeptLines& kept() {
  static KeptLines lines;
  return lines;
}

void keep(LogLevel level, const std::string& line) {
  const Lock lock(kept().mutex);
  if (kept().most == 0) return;
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  if (kept().lines.size() >= kept().most) kept().lines.pop_front();
  kept().lines.push_back(
      {std::chrono::duration_cast<std::chrono::nanoseconds>(since).count(), level, line});
}

// The program's log, from start_log() on.
std::weak_ptr<QueueSink> the_log;

}  // namespace

void start_log(const std::string& name, const std::string& level) {
  {
    const Lock lock(kept().mutex);
    kept().name = name;
  }
  auto sink = std::make_shared<QueueSink>(name);
  the_log = sink;
  auto logger = std::make_shared<spdlog::logger>(name, std::move(sink));
  logger->set_level(spdlog::level::from_str(level));
  logger->set_error_handler([](const std::string&) {});
  spdlog::set_default_logger(std::move(logger));
}

bool is_logged(LogLevel level) { return spdlog::should_log(kLevels[static_cast<int>(level)]); }

void log_text(LogLevel level, std::string_view text, std::string_view code) {
  const std::string line = code.empty() ? std::string(text) : fmt::format("{} [{}]", text, code);
  spdlog::default_logger_raw()->log(kLevels[static_cast<int>(level)], std::string_view(line));
  keep(level, line);
  note_intervention(code, text);
}

void keep_lines(std::size_t most) {
  const Lock lock(kept().mutex);
  kept().most = most;
}

std::string log_name() {
  const Lock lock(kept().mutex);
  return kept().name;
}

std::vector<LoggedLine> kept_lines() {
  const Lock lock(kept().mutex);
  std::vector<LoggedLine> lines(std::make_move_iterator(kept().lines.begin()),
                                std::make_move_iterator(kept().lines.end()));
  kept().lines.clear();
  return lines;
}

void drain_log() {
  if (const auto log = the_log.lock()) log->drain();
}

}  // namespace clearance
