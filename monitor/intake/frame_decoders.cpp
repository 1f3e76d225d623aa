#include "monitor/intake/frame_decoders.hpp"

#include <algorithm>
#include <array>

#include "monitor/intake/camera_clouds.hpp"
#include "monitor/intake/laser_scan.hpp"
#include "monitor/intake/map_clouds.hpp"
#include "monitor/wire/camera_types.hpp"
#include "monitor/wire/moveit_types.hpp"

namespace clearance {
namespace {

using enum RawSensorMessage::Type;

// The class has a `sample` of the message, and read(message, sensor), which returns false if the
// message says nothing of what the sensor sees.
template <class Cloud>
std::unique_ptr<MessageCloud> decode_cloud(const RawSensorMessage& message, const Sensor& sensor,
                                           CdrDecoder& decoder) {
  auto cloud = std::make_unique<Cloud>();
  if (!decoder.decode(message.cdr, cloud->sample, message.bytes)) {
    cloud->fault = FrameFault::kUndecodable;
  } else if (!cloud->read(message, sensor)) {
    return nullptr;
  }
  return cloud;
}

constexpr std::array kFrameDecoders = {
    FrameDecoder{kImage, SensorKind::kDepthImage, "sensor_msgs/msg/Image", &kRosImage,
                 decode_cloud<ImageCloud>},
    FrameDecoder{kPoints, SensorKind::kPoints, "sensor_msgs/msg/PointCloud2", &kRosPointCloud2,
                 decode_cloud<PointsCloud>},
    FrameDecoder{kOctomap, SensorKind::kOctomap, "octomap_msgs/msg/Octomap", &kRosOctomap,
                 decode_cloud<OctomapCloud>},
    FrameDecoder{kPlanningScene, SensorKind::kOctomap, "moveit_msgs/msg/PlanningScene",
                 &kRosPlanningScene, decode_cloud<PlanningSceneCloud>},
    FrameDecoder{kLaserScan, SensorKind::kPoints, "sensor_msgs/msg/LaserScan", &kRosLaserScan,
                 decode_cloud<ScanCloud>},
};

}  // namespace

std::span<const FrameDecoder> frame_decoders() noexcept { return kFrameDecoders; }

const FrameDecoder* frame_decoder(RawSensorMessage::Type type) noexcept {
  const auto* const found = std::ranges::find(kFrameDecoders, type, &FrameDecoder::message);
  return found == kFrameDecoders.end() ? nullptr : found;
}

bool is_frame_type(SensorKind kind, std::string_view type) noexcept {
  return std::ranges::any_of(kFrameDecoders, [&](const FrameDecoder& each) {
    return each.kind == kind && each.type == type;
  });
}

}  // namespace clearance
