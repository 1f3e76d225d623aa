#include "monitor/visual/ros_types.hpp"

#include <utility>

namespace clearance::ros {
namespace {

char* copied(std::string_view text) { return dds_string_dup(std::string(text).c_str()); }

std_msgs_msg_dds__Header_ header(std::int64_t stamp_ns, std::string_view frame) {
  return {.stamp = {.sec = static_cast<std::int32_t>(stamp_ns / 1'000'000'000),
                    .nanosec = static_cast<std::uint32_t>(stamp_ns % 1'000'000'000)},
          .frame_id = copied(frame)};
}

template <class Vector>
Vector vector_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

geometry_msgs_msg_dds__Quaternion_ quaternion(const Pose& pose) {
  const Eigen::Quaterniond q = pose.orientation.normalized();
  return {q.x(), q.y(), q.z(), q.w()};
}

std_msgs_msg_dds__ColorRGBA_ colour(const Colour& c) { return {c.red, c.green, c.blue, c.opacity}; }

// Cyclone writes a string that is null as an empty one.
void fill(const Marker& marker, std::int64_t stamp_ns, visualization_msgs_msg_dds__Marker_& out) {
  constexpr std::int32_t kAdd = 0, kDelete = 2;
  out.header = header(stamp_ns, marker.frame);
  out.ns = copied(marker.name_space);
  out.id = marker.id;
  out.type = static_cast<std::int32_t>(marker.type);
  out.action = marker.deleted ? kDelete : kAdd;
  out.pose = {vector_of<geometry_msgs_msg_dds__Point_>(marker.pose.position),
              quaternion(marker.pose)};
  out.scale = vector_of<geometry_msgs_msg_dds__Vector3_>(marker.scale);
  out.color = colour(marker.colour);
  out.frame_locked = true;  // the marker moves with its frame
  reserve_sequence(out.points, marker.points.size());
  for (const Vec3& point : marker.points) {
    out.points._buffer[out.points._length++] = vector_of<geometry_msgs_msg_dds__Point_>(point);
  }
  reserve_sequence(out.colors, marker.colours.size());
  for (const Colour& each : marker.colours) {
    out.colors._buffer[out.colors._length++] = colour(each);
  }
  out.text = copied(marker.text);
}

constexpr std::string_view kRule =
    "================================================================================\n";

std::string joined(std::string_view top, std::initializer_list<std::string_view> used) {
  std::string text(top);
  for (const std::string_view part : used) text.append(kRule).append("MSG: ").append(part);
  return text;
}

constexpr std::string_view kHeaderText =
    "std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n";
constexpr std::string_view kTimeText = "builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
constexpr std::string_view kDurationText =
    "builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n";
constexpr std::string_view kVector3Text =
    "geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";
constexpr std::string_view kPointText = "geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n";
constexpr std::string_view kQuaternionText =
    "geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";

}  // namespace

const McapSchema& transforms_schema() {
  static const McapSchema kSchema = {
      "tf2_msgs/msg/TFMessage", std::string(kSchemaEncoding),
      joined("geometry_msgs/TransformStamped[] transforms\n",
             {"geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\n"
              "geometry_msgs/Transform transform\n",
              "geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\n"
              "geometry_msgs/Quaternion rotation\n",
              kHeaderText, kTimeText, kVector3Text, kQuaternionText})};
  return kSchema;
}

const McapSchema& markers_schema() {
  static const McapSchema kSchema = {
      "visualization_msgs/msg/MarkerArray", std::string(kSchemaEncoding),
      joined("visualization_msgs/Marker[] markers\n",
             {"visualization_msgs/Marker\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\n"
              "int32 action\ngeometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\n"
              "std_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool frame_locked\n"
              "geometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\n"
              "string texture_resource\nsensor_msgs/CompressedImage texture\n"
              "visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\n"
              "string mesh_resource\nvisualization_msgs/MeshFile mesh_file\n"
              "bool mesh_use_embedded_materials\n",
              "geometry_msgs/Pose\ngeometry_msgs/Point position\n"
              "geometry_msgs/Quaternion orientation\n",
              "std_msgs/ColorRGBA\nfloat32 r\nfloat32 g\nfloat32 b\nfloat32 a\n",
              "sensor_msgs/CompressedImage\nstd_msgs/Header header\nstring format\nuint8[] data\n",
              "visualization_msgs/UVCoordinate\nfloat32 u\nfloat32 v\n",
              "visualization_msgs/MeshFile\nstring filename\nuint8[] data\n", kHeaderText,
              kTimeText, kDurationText, kVector3Text, kPointText, kQuaternionText})};
  return kSchema;
}

Sample<TransformMessage> transform_message(std::int64_t stamp_ns,
                                           std::span<const Transform> transforms) {
  Sample<TransformMessage> sample;
  auto& out = sample->transforms;
  reserve_sequence(out, transforms.size());
  for (const Transform& transform : transforms) {
    out._buffer[out._length++] = {
        header(stamp_ns, kWorldFrame),
        copied(transform.child),
        {vector_of<geometry_msgs_msg_dds__Vector3_>(transform.pose.position),
         quaternion(transform.pose)}};
  }
  return sample;
}

Sample<MarkerArray> marker_array(std::int64_t stamp_ns, std::span<const Marker> markers) {
  Sample<MarkerArray> sample;
  auto& out = sample->markers;
  reserve_sequence(out, markers.size());
  for (const Marker& marker : markers) fill(marker, stamp_ns, out._buffer[out._length++]);
  return sample;
}

}  // namespace clearance::ros
