// What a daemon publishes beside a report: gradients and separations of the same tick, zones and
// health.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <chrono>
#include <cstdint>
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

  // The message of this tick, valid until the next call; null: none came. The daemon sends it right
  // behind the report, so a daemon that sends such messages is waited for.
  [[nodiscard]] const Message* of(std::uint64_t daemon, std::uint64_t cycle) {
    const auto is_before = [&] { return stream_->daemon != daemon || stream_->cycle < cycle; };
    while (is_before()) {
      if (stream_.next()) continue;
      if (stream_.daemons() == 0 || !stream_.next(kPatience)) return nullptr;
    }
    return stream_->cycle == cycle ? &*stream_ : nullptr;
  }

 private:
  static constexpr std::chrono::milliseconds kPatience{20};
  client::Stream<Message> stream_;
};

// As Python sees them; these need the lock. `joints` is the number of the scene's joints.
struct GradientArrays {
  py::array rates;   // (rows, joints)
  py::array drifts;  // (rows,)
};
// A row for each of `pairs`, which are ids. NaN: the message has no such pair, or an entry is not
// known.
[[nodiscard]] GradientArrays gradient_arrays(const clearance_msg_Gradients& message,
                                             const std::vector<std::uint32_t>& pairs,
                                             std::size_t joints);

struct SeparationArrays {
  py::array zones, pairs;
};
[[nodiscard]] SeparationArrays separation_arrays(const clearance_msg_Separation& message);

// The state of every zone by its name, as records.
// By name; `names` are those of zones by id, for a state that has none yet.
[[nodiscard]] py::dict zones_of(const client::Zones& zones, const py::list& names);

// A dict with the fields of the message; lists of dicts for its sequences.
[[nodiscard]] py::dict health_of(const clearance_msg_Health& message);

}  // namespace clearance::python
