#include "monitor/visual/ros_types.hpp"

#include <bit>
#include <cstring>
#include <type_traits>

namespace clearance::ros {
namespace {

// XCDR1, little-endian: every number aligned to its own size, counted from behind the header.
class CdrBytes {
 public:
  CdrBytes() {
    static_assert(std::endian::native == std::endian::little);
    bytes_ = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
  }
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void add(Number value) {
    constexpr std::size_t kHeader = 4;
    while ((bytes_.size() - kHeader) % sizeof(Number) != 0) bytes_.push_back(std::byte{0});
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof(Number));
    std::memcpy(&bytes_[at], &value, sizeof(Number));
  }
  void add(std::string_view text) {
    add(static_cast<std::uint32_t>(text.size() + 1));
    const auto* const begin = reinterpret_cast<const std::byte*>(text.data());
    bytes_.insert(bytes_.end(), begin, begin + text.size());
    bytes_.push_back(std::byte{0});
  }
  void add(const Vec3& v) {
    for (int i = 0; i < 3; ++i) add(v[i]);
  }
  void add(const Pose& pose) {
    add(pose.position);
    const Eigen::Quaterniond q = pose.orientation.normalized();
    for (const double number : {q.x(), q.y(), q.z(), q.w()}) add(number);
  }
  void add(const Colour& c) {
    for (const float number : {c.red, c.green, c.blue, c.opacity}) add(number);
  }
  void add_time(std::int64_t ns) {
    add(static_cast<std::int32_t>(ns / 1'000'000'000));
    add(static_cast<std::uint32_t>(ns % 1'000'000'000));
  }
  void add_header(std::int64_t stamp_ns, std::string_view frame) {
    add_time(stamp_ns);
    add(frame);
  }
  template <class Item>
  void add_sequence(const std::vector<Item>& items) {
    add(static_cast<std::uint32_t>(items.size()));
    for (const Item& item : items) add(item);
  }
  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

void add_empty_sequence(CdrBytes& out) { out.add(std::uint32_t{0}); }

// texture, uv_coordinates, text, mesh_resource, mesh_file, mesh_use_embedded_materials.
void add_marker_tail(CdrBytes& out, const Marker& marker) {
  out.add(std::string_view{});  // texture_resource
  out.add_header(0, {});        // texture: header, format, data
  out.add(std::string_view{});
  add_empty_sequence(out);
  add_empty_sequence(out);  // uv_coordinates
  out.add(std::string_view(marker.text));
  out.add(std::string_view{});  // mesh_resource
  out.add(std::string_view{});  // mesh_file: filename, data
  add_empty_sequence(out);
  out.add(std::uint8_t{0});
}

void add_marker(CdrBytes& out, std::int64_t stamp_ns, const Marker& marker) {
  constexpr std::int32_t kAdd = 0, kDelete = 2;
  out.add_header(stamp_ns, marker.frame);
  out.add(marker.name_space);
  out.add(marker.id);
  out.add(static_cast<std::int32_t>(marker.type));
  out.add(marker.deleted ? kDelete : kAdd);
  out.add(marker.pose);
  out.add(marker.scale);
  out.add(marker.colour);
  out.add_time(0);           // lifetime: for ever
  out.add(std::uint8_t{1});  // frame_locked: it moves with its frame
  out.add_sequence(marker.points);
  out.add_sequence(marker.colours);
  add_marker_tail(out, marker);
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

std::vector<std::byte> encode(std::int64_t stamp_ns, std::span<const Transform> transforms) {
  CdrBytes out;
  out.add(static_cast<std::uint32_t>(transforms.size()));
  for (const Transform& transform : transforms) {
    out.add_header(stamp_ns, kWorldFrame);
    out.add(transform.child);
    out.add(transform.pose);
  }
  return out.take();
}

std::vector<std::byte> encode(std::int64_t stamp_ns, std::span<const Marker> markers) {
  CdrBytes out;
  out.add(static_cast<std::uint32_t>(markers.size()));
  for (const Marker& marker : markers) add_marker(out, stamp_ns, marker);
  return out.take();
}

}  // namespace clearance::ros
