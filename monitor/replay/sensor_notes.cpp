#include "monitor/replay/sensor_notes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace clearance {

std::vector<std::string> sensor_notes(const Sensors& sensors, const Scene& scene) {
  std::vector<std::string> notes;
  for (std::uint32_t i = 0; i < scene.sensors.size(); ++i) {
    const SensorStatus status = sensors.status(i);
    const std::string& name = scene.sensors[i].name;
    const bool any_came = std::ranges::any_of(status.counts, [](auto count) { return count > 0; });
    if (!any_came) {
      notes.push_back(fmt::format(
          "sensor '{}': no message of it was found: the cell says that it publishes on '{}'", name,
          scene.sensors[i].topic));
      continue;
    }
    notes.push_back(fmt::format(
        "sensor '{}': {} frames used, the last one with {} elements; its place was known to {:.2g} "
        "m at worst",
        name, status.frames, status.elements, status.largest_pose_error));
    for (std::size_t fault = 1; fault < kFrameFaults; ++fault) {
      if (status.counts[fault] == 0) continue;
      notes.push_back(fmt::format("sensor '{}': {} messages were refused: {}", name,
                                  status.counts[fault], text(static_cast<FrameFault>(fault))));
    }
    if (status.hidden + status.cropped > 0) {
      notes.push_back(fmt::format(
          "sensor '{}': of the last frame, {} elements were hidden because too few frames have "
          "them, and {} were cropped because no link reaches them",
          name, status.hidden, status.cropped));
    }
    if (!scene.sensors[i].unseen) {
      notes.push_back(
          fmt::format("sensor '{}': places that it has not seen were not looked for", name));
    }
    const auto thickest = std::ranges::max_element(status.own, {}, &OwnImageStatus::thickest);
    if (thickest == status.own.end() || thickest->thickest == 0.0) continue;
    notes.push_back(
        fmt::format("sensor '{}': the robot's own image was left out; what is within {:.4f} m of "
                    "'{}', and less of the other links, may have been left out with it",
                    name, thickest->thickest, scene.objects[thickest->object].name));
  }
  return notes;
}

}  // namespace clearance
