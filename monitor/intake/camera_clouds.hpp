// Depth images and points, as their messages show them.
#pragma once

#include <cstdint>
#include <vector>

#include "monitor/intake/message_cloud.hpp"

namespace clearance {

class ImageCloud final : public MessageCloud {
 public:
  Sample<sensor_msgs_msg_dds__Image_> sample;

  [[nodiscard]] bool read(const RawSensorMessage& message, const Sensor& sensor);
  [[nodiscard]] const DepthImage* image() const noexcept override { return &image_; }
  [[nodiscard]] FrameFault elements(const Sensor&, std::vector<MeasuredPoint>&,
                                    double&) const override {
    return FrameFault::kCannotBuild;
  }
  [[nodiscard]] std::uint32_t depth_digest(std::size_t i) const noexcept override;

 private:
  DepthImage image_;
};

class PointsCloud final : public MessageCloud {
 public:
  Sample<sensor_msgs_msg_dds__PointCloud2_> sample;

  [[nodiscard]] bool read(const RawSensorMessage& message, const Sensor& sensor);
  [[nodiscard]] FrameFault elements(const Sensor& sensor, std::vector<MeasuredPoint>& out,
                                    double& excess) const override;
  [[nodiscard]] std::uint32_t depth_digest(std::size_t i) const noexcept override;

  // A cloud in one row leaves out what it has not seen.
  [[nodiscard]] bool is_picture() const noexcept override { return rows > 1; }

 private:
  PointsView points_;
};

}  // namespace clearance
