// Logs that zones were entered and left, and why. A zone that flickers does not flood the log.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "config/scene/scene.hpp"
#include "monitor/interface/report.hpp"

namespace clearance {

class ZoneLog {
 public:
  // The most lines of one zone, and of all zones, between two calls of end_second().
  static constexpr std::uint64_t kLinesOfAZone = 4, kLinesOfAll = 40;

  // The scene must outlive this, or its use until the next call of change().
  explicit ZoneLog(const Scene& scene) : scene_(&scene) {}
  // The following reports are of this scene. Zones are known by their names.
  void change(const Scene& scene) { scene_ = &scene; }

  // Logs a change of the zone, or counts it where its lines are used up.
  void note(std::uint32_t zone, const ZoneReport& report, std::uint64_t cycle);
  // Logs the number of changes that have been left out since the last call.
  void end_second();

 private:
  struct Zone {
    std::uint64_t lines = 0, left_out = 0;
    bool active = false;
  };

  const Scene* scene_;
  std::map<std::string, Zone> zones_;
  std::uint64_t lines_ = 0;
};

}  // namespace clearance
