// The log of what people and other programs did to a running program: a file whose lines are
// chained (monitor/files/chained_log.hpp).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

#include "monitor/files/chained_log.hpp"
#include "monitor/interface/mutex.hpp"

namespace clearance {

// The file cannot be opened or read. Errors after that do not stop the program; see complete().
class InterventionError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A thread of its own writes the lines, so that no other waits for the disk. Lines that find kMost
// others waiting are left out, but for the last one, and the next line counts them. If the disk is
// full, the thread tries again each second. A file that another program has changed, moved or
// deleted gets no more lines. One that has grown large is renamed (files/numbered_file.hpp), and
// its successor begins with a line that holds the hash of its last one.
//
// While it lives, log lines that tell of an intervention (is_intervention()) go into it, too.
class InterventionLog {
 public:
  static constexpr std::size_t kMost = 1024;
  static constexpr std::uint64_t kLargest = 128
                                            << 20;  // bytes; a file of twice that cannot be read

  // Begins the file, or goes on behind its last line. What stands behind the last line break was
  // never a whole line: it is cut off, and a line keeps it. Throws InterventionError.
  explicit InterventionLog(std::filesystem::path file, std::uint64_t largest = kLargest);
  ~InterventionLog();
  InterventionLog(const InterventionLog&) = delete;
  InterventionLog& operator=(const InterventionLog&) = delete;

  // Any thread but that of the tick. `fields`: an object.
  void note(std::string_view kind, const nlohmann::ordered_json& fields);
  // Notes the last line: what another thread notes after it is dropped. Waits until all lines are
  // written, at most kPatience.
  void finish(std::string_view kind, const nlohmann::ordered_json& fields);
  static constexpr std::chrono::seconds kPatience{2};
  // After finish().
  [[nodiscard]] bool complete() const noexcept { return complete_; }
  // After finish(): true when the thread still waits for the disk. The program must then end
  // without destroying this object.
  [[nodiscard]] bool hangs() const noexcept { return hangs_; }

 private:
  struct Entry {
    std::int64_t time_ns;
    std::string kind, fields;
  };
  void open();
  void run();
  void put(std::string_view kind, const nlohmann::ordered_json& fields) REQUIRES(mutex_);
  void begin_next_file();
  // Each returns why it failed; empty: it is done.
  [[nodiscard]] std::string write(const Entry& entry, std::uint64_t left_out);
  [[nodiscard]] std::string changed_by_others() const;

  const std::filesystem::path file_;
  const std::uint64_t largest_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;  // of the whole lines
  ChainEnd end_;
  std::string continues_;  // fields of the first line of a file that goes on from another
  Mutex mutex_;
  std::condition_variable news_;
  GUARDED_BY(mutex_) std::deque<Entry> waiting_;
  GUARDED_BY(mutex_) std::uint64_t left_out_ = 0;
  GUARDED_BY(mutex_) bool is_ending_ = false, is_lost_ = false, has_ended_ = false;
  bool complete_ = false, hangs_ = false;
  std::thread thread_;
};

// True for the codes of log lines that tell what people and programs did: to the scene, as sources,
// or as partners.
[[nodiscard]] bool is_intervention(std::string_view code) noexcept;

// Puts a log line into the log of interventions, if there is one and the line belongs there.
void note_intervention(std::string_view code, std::string_view text);

}  // namespace clearance
