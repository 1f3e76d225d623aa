#include "monitor/replay/sensor_notes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "config/text/sentences.hpp"

namespace clearance {

namespace {

bool is_unheard(const SensorStatus& status) { return status.frames == 0 && status.heard == 0; }

// Messages came, but none was good or was refused with a cause. A good frame may still have waited
// for something at the end of the log.
bool is_without_frames(const SensorStatus& status) {
  return status.frames == 0 && status.heard > 0 &&
         std::ranges::all_of(status.counts, [](auto count) { return count == 0; });
}

}  // namespace

std::vector<std::string> unheard_sensors(const Sensors* sensors, const Scene& scene,
                                         const InputLog* log) {
  std::vector<std::string> texts;
  for (std::uint32_t i = 0; sensors != nullptr && i < scene.sensors.size(); ++i) {
    const SensorStatus status = sensors->status(i);
    const Sensor& sensor = scene.sensors[i];
    if (is_without_frames(status)) {
      texts.push_back(fmt::format(
          "sensor '{}': {} came on its topic '{}', but no frame could be made of them: {}",
          sensor.name, counted(status.heard, "message"), sensor.topic,
          sensor.kind == SensorKind::kOctomap
              ? std::string("none had an octomap")
              : fmt::format("no CameraInfo came on '{}'", sensor.camera_info)));
    }
    if (!is_unheard(status)) continue;
    if (log == nullptr || !log->has_topics()) {
      texts.push_back(
          fmt::format("sensor '{}': the recording has no image that this cell can use: the daemon "
                      "used none, as its log says, or the cell has another entry of this sensor",
                      sensor.name));
      continue;
    }
    const std::vector<std::string> topics = log->topics_of(sensor.kind);
    texts.push_back(fmt::format(
        "sensor '{}': no message was found on its topic '{}', so nothing is known of what it sees; "
        "{}",
        sensor.name, sensor.topic,
        topics.empty() ? std::string("the log has no topic of such a sensor")
                       : fmt::format("topics of such sensors are {}", fmt::join(topics, ", "))));
  }
  return texts;
}

std::vector<std::string> sensor_notes(const Sensors& sensors, const Scene& scene) {
  std::vector<std::string> notes;
  for (std::uint32_t i = 0; i < scene.sensors.size(); ++i) {
    const SensorStatus status = sensors.status(i);
    const std::string& name = scene.sensors[i].name;
    if (is_unheard(status)) continue;
    notes.push_back(fmt::format(
        "sensor '{}': {} frames used, the last one with {} elements; its place was known to {:.2g} "
        "m at worst",
        name, status.frames, status.elements, status.largest_pose_error));
    for (std::size_t fault = 1; fault < kFrameFaults; ++fault) {
      if (status.counts[fault] == 0) continue;
      notes.push_back(fmt::format("sensor '{}': refused {}: {}", name,
                                  counted(status.counts[fault], "message"),
                                  text(static_cast<FrameFault>(fault))));
      if (static_cast<FrameFault>(fault) == FrameFault::kRobotElsewhere &&
          !status.robot_elsewhere.empty()) {
        notes.back() += ": " + status.robot_elsewhere;
      }
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
