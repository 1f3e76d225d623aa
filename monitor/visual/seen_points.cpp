#include "monitor/visual/seen_points.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

namespace clearance {
namespace {

constexpr std::uint32_t kStep = 16;  // bytes a point
constexpr std::uint8_t kFloat32 = 7, kUint32 = 6;

// The middle of an element in the sensor's frame.
Vec3 middle_of(const DepthCloud& cloud, std::size_t block, std::size_t lane) {
  return cloud.pixel_slab(block, lane).middle();
}
Vec3 middle_of(const PointCloud& cloud, std::size_t block, std::size_t lane) {
  const PointCloud::Block& points = cloud.block(block);
  return {points.x[lane], points.y[lane], points.z[lane]};
}

bool is_present(const DepthCloud& cloud, std::size_t block, std::size_t lane) {
  return !DepthCloud::is_empty(cloud.node(0, block)) &&
         cloud.block(block).low[lane] <= cloud.block(block).high[lane];
}
bool is_present(const PointCloud& cloud, std::size_t block, std::size_t lane) {
  return cloud.block(block).is_present(lane);
}

// Neighbours are together in a block, so that every n-th element spreads evenly.
template <class Cloud>
std::vector<Vec3> some_middles(const Cloud& cloud, std::size_t most) {
  std::vector<Vec3> middles;
  const std::size_t stride =
      std::max<std::size_t>(1, (cloud.size() + most - 1) / std::max<std::size_t>(1, most));
  std::size_t number = 0;
  for (std::size_t block = 0; block < cloud.blocks(); ++block) {
    for (std::size_t lane = 0; lane < Cloud::kFanOut; ++lane) {
      if (!is_present(cloud, block, lane) || number++ % stride != 0) continue;
      middles.push_back(middle_of(cloud, block, lane));
    }
  }
  return middles;
}

void set_field(sensor_msgs_msg_dds__PointField_& field, const char* name, std::uint32_t offset,
               std::uint8_t type) {
  field.name = dds_string_dup(name);
  field.offset = offset;
  field.datatype = type;
  field.count = 1;
}

}  // namespace

const McapSchema& seen_points_schema() {
  static const McapSchema kSchema = {
      "sensor_msgs/msg/PointCloud2", std::string(ros::kSchemaEncoding),
      std::string("std_msgs/Header header\nuint32 height\nuint32 width\n"
                  "sensor_msgs/PointField[] fields\nbool is_bigendian\nuint32 point_step\n"
                  "uint32 row_step\nuint8[] data\nbool is_dense\n"
                  "=====================================================================\n"
                  "MSG: sensor_msgs/PointField\nstring name\nuint32 offset\nuint8 datatype\n"
                  "uint32 count\n"
                  "=====================================================================\n"
                  "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
                  "=====================================================================\n"
                  "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n")};
  return kSchema;
}

Sample<sensor_msgs_msg_dds__PointCloud2_> seen_points_message(const SeenCloud& cloud,
                                                              const Pose& world_from_sensor,
                                                              std::uint32_t sensor,
                                                              std::int64_t stamp_ns,
                                                              std::size_t most) {
  constexpr std::int64_t kSecondNs = 1'000'000'000;
  const std::vector<Vec3> middles = cloud.depth() != nullptr ? some_middles(*cloud.depth(), most)
                                                             : some_middles(*cloud.points(), most);
  Sample<sensor_msgs_msg_dds__PointCloud2_> message;
  message->header.stamp.sec = static_cast<std::int32_t>(stamp_ns / kSecondNs);
  message->header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % kSecondNs);
  message->header.frame_id = dds_string_dup(std::string(ros::kWorldFrame).c_str());
  message->height = 1;
  message->width = static_cast<std::uint32_t>(middles.size());
  reserve_sequence(message->fields, 4);
  message->fields._length = 4;
  set_field(message->fields._buffer[0], "x", 0, kFloat32);
  set_field(message->fields._buffer[1], "y", 4, kFloat32);
  set_field(message->fields._buffer[2], "z", 8, kFloat32);
  set_field(message->fields._buffer[3], "sensor", 12, kUint32);
  message->point_step = kStep;
  message->row_step = kStep * message->width;
  message->is_dense = true;
  reserve_sequence(message->data, message->row_step);
  message->data._length = message->row_step;
  const Mat3 turn = rotation_matrix(world_from_sensor.orientation);
  std::uint8_t* at = message->data._buffer;
  for (const Vec3& middle : middles) {
    const Eigen::Vector3f point = (world_from_sensor.position + turn * middle).cast<float>();
    std::memcpy(at, point.data(), 3 * sizeof(float));
    std::memcpy(at + 3 * sizeof(float), &sensor, sizeof sensor);
    at += kStep;
  }
  return message;
}

}  // namespace clearance
