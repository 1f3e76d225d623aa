// When a monitor notices a fault, and under which names it tells it: codes of the log, and causes
// of refusals. monitor/FAULTS.md has a row for each of these names, and tools/evidence joins the
// two.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "monitor/inputs/pose_batch.hpp"
#include "monitor/intake/camera_messages.hpp"
#include "monitor/sensors/sensors.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/adversary/lies.hpp"

namespace clearance::test::lies {

// By name: ms from the beginning of the fault until it is told; at 1 kHz, these are ticks.
using Detected = std::map<std::string, std::int64_t>;

// Follows the inputs of one fault's channel. A fault that strikes no input, as a command does not,
// gets no time.
class Detection {
 public:
  Detection(const Scene& scene, const Fault& fault);

  // `t` is the time of the monitor's last tick, ns since the start.
  void follow(const Monitor& monitor, const Sensors& sensors, std::int64_t t);
  [[nodiscard]] const Detected& told() const noexcept { return told_; }

 private:
  // Samples that were refused, of all these inputs.
  struct Refused {
    std::array<std::uint64_t, kRejects> samples{};
    std::array<std::uint64_t, kFrameFaults> frames{};
  };
  [[nodiscard]] Refused refused(const Monitor& monitor, const Sensors& sensors) const;
  void note(std::string_view name, std::int64_t t) { told_.emplace(name, (t - fault_.from) / kMs); }

  const Fault fault_;
  std::vector<std::uint32_t> objects_, seen_, variables_, sensors_;  // seen: objects of sensors
  Refused before_;                                                   // the fault
  Detected told_;
};

}  // namespace clearance::test::lies
