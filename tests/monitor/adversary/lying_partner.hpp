// A partner that goes on from the saved state of the loop of a run, and whose reports count from
// then on. It gets the same inputs as the loop, so both have to tell the same bits.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <vector>

#include "monitor/loop/tick_loop.hpp"
#include "monitor/tick/tick_state.hpp"

namespace clearance::test::lies {

class LyingPartner {
 public:
  // Before a tick to which no frame of a sensor has come: the loop renews its monitor, and passes
  // its state on. `sink` goes on to get the loop's reports. The loop is not busy.
  LyingPartner(TickLoop& loop, ReportSink& sink);

  [[nodiscard]] bool is_used(const SeenCloud* cloud) const noexcept {
    return frames_.is_used(cloud);
  }
  void put(std::uint32_t sensor, const SensorFrame& frame) noexcept {
    frames_.put(sensor, frame, scene_.revision);
  }
  void input(const PoseBatch& batch) { batches_.push_back(batch); }
  void catch_up() { offer_.catch_up(); }
  // Ticks as the loop did. Returns the report, until the next tick; null: it has not begun.
  const Report* tick(const Report& of_loop);
  // True if it has told other bits in the last tick than the loop.
  [[nodiscard]] bool differs() const noexcept { return differs_; }

 private:
  TickLoop& loop_;
  const Scene& scene_;
  TickRecords records_;
  SceneOffer offer_;
  FrameExchange frames_;
  TickState state_;
  bool has_begun_ = false, differs_ = false;
  std::vector<PoseBatch> batches_;  // of the coming tick
};

}  // namespace clearance::test::lies
