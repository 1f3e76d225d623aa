#include "monitor/app/intervention_log.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include <nlohmann/json.hpp>

#include "config/text/file_bytes.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/files/numbered_file.hpp"
#include "monitor/interface/mutex.hpp"

namespace clearance {
namespace {

using nlohmann::ordered_json;

constexpr int kMode = 0640;
// The pause between two attempts to write.
constexpr std::chrono::seconds kPause{1};
// Bytes of a torn line that its successor keeps.
constexpr std::size_t kMostTorn = 1000;

constexpr std::array kInterventions = {lines::kReading.code,         lines::kSceneRefused.code,
                                       lines::kCommandRefused.code,  lines::kCommandsLeftOut.code,
                                       lines::kNoted.code,           lines::kNewSource.code,
                                       lines::kSourceChanged.code,   lines::kSourceTakenOver.code,
                                       lines::kSourceRefused.code,   lines::kTwoSources.code,
                                       lines::kTwoJointSources.code, lines::kMoreLeftOut.code,
                                       lines::kPartnerStands.code,   lines::kOtherDaemonFirst.code,
                                       lines::kSelfTestFailed.code};

// A thread of DDS may log while the program ends.
Mutex open_mutex;
GUARDED_BY(open_mutex) InterventionLog* open_log = nullptr;

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

// An object without its braces. Bytes that are no UTF-8 are replaced.
std::string members(const ordered_json& fields) {
  const std::string text = fields.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  return text.substr(1, text.size() - 2);
}

}  // namespace

bool is_intervention(std::string_view code) noexcept {
  return std::ranges::find(kInterventions, code) != kInterventions.end();
}

void note_intervention(std::string_view code, std::string_view text) {
  if (!is_intervention(code)) return;
  const Lock lock(open_mutex);
  if (open_log != nullptr) open_log->note(code, {{"text", text}});
}

InterventionLog::InterventionLog(std::filesystem::path file, std::uint64_t largest)
    : file_(std::move(file)), largest_(largest) {
  open();
  thread_ = std::thread([this] {
    pthread_setname_np(pthread_self(), "interventions");
    run();
  });
  const Lock lock(open_mutex);
  open_log = this;
}

InterventionLog::~InterventionLog() {
  {
    const Lock lock(open_mutex);
    open_log = nullptr;
  }
  {
    const Lock lock(mutex_);
    is_ending_ = true;
    news_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
  if (descriptor_ >= 0) ::close(descriptor_);
}

// Locks the file: two programs would both follow the same line.
void InterventionLog::open() {
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK, kMode);
  struct stat status {};
  const auto fail = [this](const std::string& why) {
    if (descriptor_ >= 0) ::close(descriptor_);
    throw InterventionError(fmt::format("--interventions: '{}' {}", file_.string(), why));
  };
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0)
    fail(fmt::format("cannot be opened: {}", std::strerror(errno)));
  if (!S_ISREG(status.st_mode)) fail("is no regular file");
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
    fail("is written by another program: give each daemon a file of its own");
  ChainedLog log = read_chained_log(file_);
  if (!log.error.empty())
    fail("cannot be read: " + log.error + "; move it away, or name another file");
  end_ = std::move(log.end);
  size_ = static_cast<std::uint64_t>(status.st_size) - log.torn.size();
  log_line(lines::kInterventions, file_.string(), end_.number, end_.hash);
  if (!log.fault.empty()) {
    log_line(lines::kInterventionsBroken, file_.string(), log.fault);
    note("broken", {{"text", log.fault}});
  }
  if (log.torn.empty()) return;
  if (::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0)
    fail(fmt::format("cannot be written: {}", std::strerror(errno)));
  log_line(lines::kInterventionsTorn, file_.string(), log.torn.size());
  note("torn", {{"bytes", log.torn.size()}, {"text", log.torn.substr(0, kMostTorn)}});
}

void InterventionLog::note(std::string_view kind, const ordered_json& fields) {
  const Lock lock(mutex_);
  if (is_ending_) return;
  waiting_.size() < kMost ? put(kind, fields) : void(++left_out_);
}

void InterventionLog::put(std::string_view kind, const ordered_json& fields) {
  if (is_lost_) {
    ++left_out_;
    return;
  }
  waiting_.push_back({now_ns(), std::string(kind), members(fields)});
  news_.notify_all();
}

void InterventionLog::run() {
  bool is_told = false;
  Lock lock(mutex_);
  while (true) {
    news_.wait(lock, [this]() REQUIRES(mutex_) { return is_ending_ || !waiting_.empty(); });
    if (waiting_.empty()) break;
    // Entries are added at the back only, which leaves the first one in its place.
    const Entry& entry = waiting_.front();
    const std::uint64_t left_out = left_out_;
    lock.unlock();
    const std::string change = changed_by_others();
    const std::string why = change.empty() ? write(entry, left_out) : change;
    if (!why.empty() && !std::exchange(is_told, true))
      log_line(lines::kInterventionsNotWritten, file_.string(), why);
    if (why.empty() && std::exchange(is_told, false))
      log_line(lines::kInterventionsWritten, file_.string());
    lock.lock();
    is_lost_ = !change.empty();
    if (is_lost_ || (!why.empty() && is_ending_)) break;
    if (!why.empty()) {
      news_.wait_for(lock, kPause, [this]() REQUIRES(mutex_) { return is_ending_; });
      continue;
    }
    left_out_ -= left_out;
    waiting_.pop_front();
  }
  has_ended_ = true;
  news_.notify_all();
}

// Names a change by another program: the next line would hide that the log was cut.
std::string InterventionLog::changed_by_others() const {
  struct stat ours {
  }, named{};
  if (::fstat(descriptor_, &ours) != 0) return std::strerror(errno);
  const bool is_there = ::stat(file_.c_str(), &named) == 0 && named.st_dev == ours.st_dev &&
                        named.st_ino == ours.st_ino;
  if (!is_there) return "another program has moved or deleted it";
  if (static_cast<std::uint64_t>(ours.st_size) == size_) return {};
  return fmt::format("another program has changed it: it has {} bytes; expected {}", ours.st_size,
                     size_);
}

// If it fails, the lines go on in the same file.
void InterventionLog::begin_next_file() {
  const std::filesystem::path former = first_free(next_number(file_));
  if (::rename(file_.c_str(), former.c_str()) != 0) return;
  const int next =
      ::open(file_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC | O_NONBLOCK, kMode);
  if (next < 0 || ::flock(next, LOCK_EX | LOCK_NB) != 0) {
    if (next >= 0) ::close(next);
    (void)::rename(former.c_str(), file_.c_str());
    return;
  }
  ::close(std::exchange(descriptor_, next));
  size_ = 0;
  log_line(lines::kInterventions, former.string(), end_.number, end_.hash);
  continues_ =
      members({{"file", former.filename().string()}, {"lines", end_.number}, {"last", end_.hash}});
  end_ = {};
}

// Removes what was written of a line if it fails, so that run() can write it again.
std::string InterventionLog::write(const Entry& entry, std::uint64_t left_out) {
  if (size_ >= largest_) begin_next_file();
  ChainEnd end = end_;
  std::string text;
  if (!continues_.empty()) text = next_line(end, now_ns(), "continues", continues_);
  if (left_out > 0) text += next_line(end, now_ns(), "left-out", members({{"count", left_out}}));
  text += next_line(end, entry.time_ns, entry.kind, entry.fields);
  if (!write_bytes(descriptor_, text) || ::fdatasync(descriptor_) != 0) {
    const int error = errno;
    if (::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) return std::strerror(errno);
    return std::strerror(error);
  }
  size_ += text.size();
  continues_.clear();
  end_ = std::move(end);
  return {};
}

void InterventionLog::finish(std::string_view kind, const ordered_json& fields) {
  Lock lock(mutex_);
  put(kind, fields);
  is_ending_ = true;
  news_.notify_all();
  hangs_ = !news_.wait_for(lock, kPatience, [this]() REQUIRES(mutex_) { return has_ended_; });
  complete_ = !hangs_ && waiting_.empty() && left_out_ == 0;
  if (!hangs_) log_line(lines::kInterventions, file_.string(), end_.number, end_.hash);
}

}  // namespace clearance
