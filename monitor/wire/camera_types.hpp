// The types of ROS 2 that cameras send, as wire/ros_types.hpp has the others.
#pragma once

#include "camera.h"
#include "monitor/wire/ros_types.hpp"

namespace clearance {

template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<sensor_msgs_msg_dds__Image_>() noexcept {
  return sensor_msgs_msg_dds__Image__desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<sensor_msgs_msg_dds__CameraInfo_>() noexcept {
  return sensor_msgs_msg_dds__CameraInfo__desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<sensor_msgs_msg_dds__PointCloud2_>() noexcept {
  return sensor_msgs_msg_dds__PointCloud2__desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<sensor_msgs_msg_dds__LaserScan_>() noexcept {
  return sensor_msgs_msg_dds__LaserScan__desc;
}

// Drivers of cameras publish best effort and keep few messages. Only the newest counts. Some send
// CameraInfo once, and keep it for late readers.
inline constexpr RosType kRosImage{
    &sensor_msgs_msg_dds__Image__desc,
    "typehash=RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47;", false, 2};
inline constexpr RosType kRosCameraInfo{
    &sensor_msgs_msg_dds__CameraInfo__desc,
    "typehash=RIHS01_b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275;",
    false,
    2,
    2,
    false,
    true};
inline constexpr RosType kRosPointCloud2{
    &sensor_msgs_msg_dds__PointCloud2__desc,
    "typehash=RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5;", false, 2};
inline constexpr RosType kRosLaserScan{
    &sensor_msgs_msg_dds__LaserScan__desc,
    "typehash=RIHS01_64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828;", false, 2};

}  // namespace clearance
