// Reports, for each pair of a sensor and a link, what the frame in use cannot show near the link.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/interface/report.hpp"

namespace clearance {

class SeenCloud;

class HiddenPlaces {
 public:
  explicit HiddenPlaces(const Scene& scene);

  // The frame of this sensor that is in use from now on. noexcept, no heap.
  void take(std::uint32_t sensor, const SeenCloud& cloud) noexcept;
  // No frame of the sensor is in use.
  void forget(std::uint32_t sensor) noexcept;

  // In the order of hidden_pairs().
  [[nodiscard]] std::span<const HiddenReport> reports() const noexcept { return reports_; }

 private:
  struct Place {
    std::uint32_t sensor = 0, object = 0;
  };
  std::vector<Place> places_;  // by report
  std::vector<HiddenReport> reports_;
};

}  // namespace clearance
