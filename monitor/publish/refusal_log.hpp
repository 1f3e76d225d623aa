// Logs for a person which inputs were refused, and why: one line a cause, however many inputs share
// it. One that lasts is repeated after ten seconds, and then after twice the time before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "monitor/wire/dds_sample.hpp"

namespace clearance {

class RefusalLog {
 public:
  // Logs up to `most` of the lines that are due, and returns how many were. The others are due in
  // the next second. Called once per second, with every health sample.
  std::size_t update(const clearance_msg_Health& health, std::size_t most);
  // The counts of the next sample begin at zero.
  void begin_counts_anew() { before_.clear(); }

 private:
  static constexpr int kFirstPauseS = 10, kLongestPauseS = 640;
  static constexpr int kOverS = 60;  // refusals are new again after this time without one
  // The refusals of one cause: of joints, of sensors, or of objects.
  struct Refusals {
    std::vector<std::string> inputs;  // refused since the last line
    std::set<std::string> named;      // in a line, since the refusals began
    std::uint64_t count = 0;          // since the last line
    std::string last;                 // the value of the last one; empty: not known
    std::uint64_t total = 0;          // since the start
    int counted_s = 0;                // the seconds that `count` is from
    int silent_s = 0;                 // since the last line
    int pause_s = 0;                  // until the next line, unless it names another input
    int quiet_s = 0;                  // since the last refusal
  };

  void add(const clearance_msg_RejectCount& entry);
  [[nodiscard]] static bool is_due(const Refusals& refusals);

  std::map<std::pair<std::string, std::string>, std::uint64_t> before_;    // by input and cause
  std::map<std::pair<std::string_view, std::string>, Refusals> refusals_;  // by what and cause
};

}  // namespace clearance
