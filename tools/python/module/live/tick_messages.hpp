// The messages beside a report: gradients and separations of the same tick, zones and health.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <vector>

#include "monitor/client/client.hpp"

namespace clearance::python {

namespace py = pybind11;

// The messages of one topic that belong to reports. None of its functions needs the interpreter's
// lock.
template <class Message>
class TickMessages {
 public:
  TickMessages(client::Connection& connection, const client::StreamOptions& options)
      : stream_(connection, options) {}

  using Clock = std::chrono::steady_clock;

  [[nodiscard]] client::Stream<Message>& stream() noexcept { return stream_; }

  // The message of the tick of this report, valid until the next call; null: none came. It is sent
  // right behind the report. If a daemon sends such messages, this waits for at most kPatience, and
  // not beyond `end`.
  [[nodiscard]] const Message* of(const clearance_msg_Distances& report, Clock::time_point end) {
    end = std::min(end, Clock::now() + kPatience);
    for (;;) {
      if (is_of(report)) return &*stream_;
      if (is_after(report)) return nullptr;
      if (stream_.next()) continue;
      const auto left = end - Clock::now();
      if (stream_.daemons() == 0 || left <= Clock::duration::zero() || !stream_.next(left))
        return nullptr;
    }
  }

 private:
  static constexpr std::chrono::milliseconds kPatience{20};
  // A message that is later by more is of the time before a clock was set back.
  static constexpr std::int64_t kLongNs = 60'000'000'000;

  // Reports of two partners are merged, but only the leader sends such messages. Both daemons tell
  // a tick with the same inputs the same time.
  [[nodiscard]] bool is_of(const clearance_msg_Distances& report) const {
    if (stream_->cycle != report.cycle) return false;
    return *report.partner == '\0' ? stream_->daemon == report.daemon
                                   : stream_->now_ns == report.now_ns;
  }
  [[nodiscard]] bool is_after(const clearance_msg_Distances& report) const {
    if (*report.partner == '\0')
      return stream_->daemon == report.daemon && stream_->cycle > report.cycle;
    const std::int64_t later_ns = stream_->now_ns - report.now_ns;
    return later_ns > 0 && later_ns < kLongNs;
  }

  client::Stream<Message> stream_;
};

// Gradients as Python sees them. Making them needs the lock. `joints` is the number of the scene's
// joints.
struct GradientArrays {
  py::array rates;   // (rows, joints)
  py::array drifts;  // (rows,)
};
// A row for each of `pairs`, which are ids. NaN: the message has no such pair, or an entry is not
// known.
[[nodiscard]] GradientArrays gradient_arrays(const clearance_msg_Gradients& message,
                                             const std::vector<std::uint32_t>& pairs,
                                             std::size_t joints);

// The state of every zone by its name, as records. `names` are those of zones by id, for a state
// that has none yet.
using ZoneStates = std::map<std::uint32_t, clearance_msg_ZoneState>;
[[nodiscard]] py::dict zones_of(const ZoneStates& zones, const py::list& names);

// A dict with the fields of the message; lists of dicts for its sequences.
[[nodiscard]] py::dict health_of(const clearance_msg_Health& message);

}  // namespace clearance::python
