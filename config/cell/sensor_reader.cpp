#include "config/cell/sensor_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "config/cell/picture_series_reader.hpp"
#include "config/cell/ros_reader.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/scalar.hpp"
#include "core/shapes.hpp"

namespace clearance {
namespace {

// A frame of 30 Hz may be lost, and the next one late, before its pairs are stale.
constexpr std::int64_t kAgeLimitNs = 100'000'000;
constexpr std::int64_t kMostColumns = 65535;                              // monitor/clouds
constexpr std::int64_t kMostPoints = 4'000'000;                           // 200 MB of memory
constexpr Range kDepths{.least = 0.0, .most = 1e4, .above_least = true};  // m, monitor/clouds
constexpr double kMapRange = 20.0;                             // m, from the origin of an octomap
constexpr Range kFrameRates{.least = 0.01, .most = 10'000.0};  // Hz
constexpr Range kStampErrors{.least = 0.0, .most = 1000.0};    // ms
constexpr Range kSpacings{.least = 0.0, .most = 0.1};
constexpr Range kShares{.least = 0.0, .most = 1.0};

// A place is unseen if it is in the cone of a pixel. A cloud, organised or not, states no
// intrinsics, so a point that is missing leaves its cone open.
constexpr const char* why_not_unseen(SensorKind kind) noexcept {
  return kind == SensorKind::kPoints
             ? "found 'unseen' of points; expected it of a depth_image: messages of points have no "
               "camera, so nothing says which places a missing point has not seen. State the "
               "depth image of this camera instead"
             : "found 'unseen' of an octomap; expected it of a depth_image: only the occupied "
               "leaves of a map are read, not those that it has not seen. State the depth image "
               "of a camera beside it";
}

class SensorReader {
 public:
  SensorReader(const ObjectDefaults& defaults, const Quantities& quantities)
      : defaults_(defaults), quantities_(quantities), diagnostics_(quantities.diagnostics()) {}

  void read(const YamlNode& node, SensorList& list, ObjectList& objects);

 private:
  void read_topics(const YamlNode& node, MapReader& map, Sensor& sensor);
  // Keys that are there, but belong to other sensors.
  void refuse(std::initializer_list<std::pair<const YamlNode*, const char*>> keys,
              const char* of) const;
  void read_error(MapReader& map, Sensor& sensor) const;
  void read_range(const YamlNode& node, Sensor& sensor) const;
  void read_capacity(MapReader& map, Sensor& sensor) const;
  void read_points(MapReader& map, Sensor& sensor) const;
  void read_shell(MapReader& map, Sensor& sensor) const;
  void read_liveness(MapReader& map, Sensor& sensor) const;
  void refuse_large_error(const YamlNode& node, const Sensor& sensor) const;
  void read_object(MapReader& map, Object& object, bool& groups_known) const;

  const ObjectDefaults& defaults_;
  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  std::map<std::string, int> lines_;  // of the topics of images and points
};

void SensorReader::refuse(std::initializer_list<std::pair<const YamlNode*, const char*>> keys,
                          const char* of) const {
  for (const auto& [node, key] : keys) {
    if (node != nullptr)
      diagnostics_.add(*node, fmt::format("found '{}'; expected it of {}", key, of));
  }
}

// Drivers publish CameraInfo beside their images.
void SensorReader::read_topics(const YamlNode& node, MapReader& map, Sensor& sensor) {
  const YamlNode* image = map.optional("depth_image");
  const YamlNode* points = map.optional("points");
  const YamlNode* octomap = map.optional("octomap");
  const YamlNode* info = map.optional("camera_info");
  const int named = (image != nullptr) + (points != nullptr) + (octomap != nullptr);
  if (named != 1) {
    diagnostics_.add(node,
                     fmt::format("found {} of 'depth_image', 'points' and 'octomap'; expected "
                                 "one of them, with a topic of ROS 2",
                                 named == 0 ? "none" : "several"));
    return;
  }
  const YamlNode& topic = image != nullptr ? *image : points != nullptr ? *points : *octomap;
  sensor.kind = image != nullptr    ? SensorKind::kDepthImage
                : points != nullptr ? SensorKind::kPoints
                                    : SensorKind::kOctomap;
  sensor.topic = read_ros_topic(topic, "/camera/depth/image_rect_raw", diagnostics_);
  if (const auto [same, is_new] = lines_.emplace(sensor.topic, topic.line);
      !is_new && !sensor.topic.empty()) {
    diagnostics_.add(topic, fmt::format("found the topic '{}' again; expected it once (first in "
                                        "line {})",
                                        sensor.topic, same->second));
  }
  if (image == nullptr) return refuse({{info, "camera_info"}}, "depth images only");
  sensor.camera_info = info != nullptr
                           ? read_ros_topic(*info, "/camera/depth/camera_info", diagnostics_)
                           : sensor.topic.substr(0, sensor.topic.rfind('/') + 1) + "camera_info";
}

// In the unit u of the cell, the error is constant + quadratic z^2; `quadratic` is then 1/u.
void SensorReader::read_error(MapReader& map, Sensor& sensor) const {
  const YamlNode* node = map.required("depth_error");
  if (node == nullptr) return;
  MapReader error(*node, "the error of the depth", diagnostics_);
  if (const YamlNode* constant = error.required("constant")) {
    sensor.error_constant =
        quantities_.length(*constant, "the part of the error that is constant", kNotNegative)
            .value_or(0.0);
  }
  if (const YamlNode* quadratic = error.optional("quadratic")) {
    const auto number =
        read_number(*quadratic, kNotNegative,
                    "the part of the error that grows with the square of the depth", diagnostics_);
    sensor.error_quadratic = number.value_or(0.0) / to_metres(1.0, quantities_.units().length);
  }
  error.refuse_unknown_keys();
}

void SensorReader::read_range(const YamlNode& node, Sensor& sensor) const {
  const bool is_pair = node.kind == YamlNode::Kind::kSequence && node.items.size() == 2;
  if (!is_pair) {
    diagnostics_.add(node, fmt::format("found {}; expected the least and the greatest depth: "
                                       "[0.3, 4]",
                                       describe(node)));
    return;
  }
  const auto depth = [&](const YamlNode& item, const char* what) {
    const double metres = quantities_.length(item, what, kPositive).value_or(1.0);
    if (metres <= kDepths.most) return metres;
    diagnostics_.add(
        item, fmt::format("found {} m; expected {} of at most {} m", metres, what, kDepths.most));
    return 1.0;
  };
  sensor.least_depth = depth(node.items[0], "the least depth");
  sensor.greatest_depth = depth(node.items[1], "the greatest depth");
  if (sensor.least_depth > sensor.greatest_depth) {
    diagnostics_.add(node, "found a least depth above the greatest; expected [least, greatest]");
  }
}

// The error is a convex function of the depth, so it is below the depth if it is so at both ends.
void SensorReader::refuse_large_error(const YamlNode& node, const Sensor& sensor) const {
  for (const double depth : {sensor.least_depth, sensor.greatest_depth}) {
    if (depth <= 0.0 || sensor.error_at(depth) < depth) continue;
    diagnostics_.add(node, fmt::format("found a depth_error of {} m at a depth of {} m; expected "
                                       "less than the depth",
                                       sensor.error_at(depth), depth));
    return;
  }
}

void SensorReader::read_capacity(MapReader& map, Sensor& sensor) const {
  const YamlNode* size = map.optional("size");
  const YamlNode* most = map.optional("most_points");
  sensor.columns = 640;
  sensor.rows = 480;
  sensor.most_points = sensor.columns * sensor.rows;
  const bool is_image = sensor.kind == SensorKind::kDepthImage;
  refuse({{is_image ? most : nullptr, "most_points"}}, "points only");
  refuse({{is_image ? nullptr : size, "size"}}, "depth images only");
  if (is_image && size != nullptr) {
    if (size->kind != YamlNode::Kind::kSequence || size->items.size() != 2) {
      diagnostics_.add(*size, fmt::format("found {}; expected the columns and rows of the largest "
                                          "image: [640, 480]",
                                          describe(*size)));
      return;
    }
    const auto count = [&](const YamlNode& item, const char* what) {
      return static_cast<std::uint32_t>(
          read_integer(item, 1, kMostColumns, what, diagnostics_).value_or(1));
    };
    sensor.columns = count(size->items[0], "columns");
    sensor.rows = count(size->items[1], "rows");
    const std::int64_t pixels = std::int64_t{sensor.columns} * sensor.rows;
    if (pixels > kMostPoints) {
      diagnostics_.add(*size,
                       fmt::format("found {} pixels; expected at most {}", pixels, kMostPoints));
      sensor.columns = sensor.rows = 1;
    }
    sensor.most_points = sensor.columns * sensor.rows;
  }
  if (!is_image && most != nullptr) {
    sensor.most_points = static_cast<std::uint32_t>(
        read_integer(*most, 1, kMostPoints, "points", diagnostics_).value_or(1));
  }
}

void SensorReader::read_points(MapReader& map, Sensor& sensor) const {
  const YamlNode* spacing = map.optional("spacing");
  const YamlNode* along = map.optional("depth_along");
  if (sensor.kind != SensorKind::kPoints)
    return refuse({{spacing, "spacing"}, {along, "depth_along"}}, "points only");
  sensor.by_neighbours = spacing != nullptr && spacing->text == "neighbours";
  if (spacing != nullptr && !sensor.by_neighbours) {
    sensor.spacing = read_number(*spacing, kSpacings,
                                 "the distance of neighbouring rays at a depth of 1, or "
                                 "'neighbours'",
                                 diagnostics_)
                         .value_or(0.0);
  }
  if (along == nullptr) return;
  const auto axis = read_text(*along, "z or ray", diagnostics_);
  if (axis && *axis != "z" && *axis != "ray") {
    diagnostics_.add(*along, fmt::format("found '{}'; expected z (a depth camera) or ray (the "
                                         "distance from the sensor)",
                                         *axis));
  }
  sensor.along_ray = axis == "ray";
}

void SensorReader::read_shell(MapReader& map, Sensor& sensor) const {
  if (const YamlNode* shell = map.optional("own_shell")) {
    sensor.own_shell =
        quantities_.length(*shell, "the shell around the robot", kNotNegative).value_or(0.0);
  }
  const YamlNode* most = map.optional("most_shell");
  if (most != nullptr) {
    sensor.most_shell =
        quantities_.length(*most, "the thickest shell around the robot", kNotNegative)
            .value_or(sensor.own_shell);
    if (sensor.most_shell < sensor.own_shell) {
      diagnostics_.add(*most, fmt::format("found a most_shell of {} m below the own_shell of {} m; "
                                          "expected at least that",
                                          sensor.most_shell, sensor.own_shell));
    }
  }
  sensor.most_shell = std::max(sensor.most_shell, sensor.own_shell);
  if (const YamlNode* trusted = map.optional("trusted_shell")) {
    sensor.trusted_shell =
        quantities_
            .length(*trusted, "the thickest shell beside which other objects are trusted",
                    kNotNegative)
            .value_or(0.0);
  }
  sensor.trusted_shell = std::max(sensor.trusted_shell, sensor.own_shell);
  if (const YamlNode* knows = map.optional("knows"))
    sensor.knows = read_flag(*knows, diagnostics_).value_or(false);
}

// A map is made of many pictures: it may stay as it is, and what it shows is no share of a picture.
void SensorReader::read_liveness(MapReader& map, Sensor& sensor) const {
  const YamlNode* noise = map.optional("noise");
  const YamlNode* least = map.optional("least_seen");
  if (sensor.kind == SensorKind::kOctomap)
    return refuse({{noise, "noise"}, {least, "least_seen"}}, "depth images and points only");
  if (noise != nullptr) {
    const auto said = read_text(*noise, "none, of a simulation", diagnostics_);
    sensor.has_noise = said != "none";
    if (said && sensor.has_noise)
      diagnostics_.add(*noise, fmt::format("found '{}'; expected none, of a simulation", *said));
  }
  if (least != nullptr) {
    sensor.least_seen =
        read_number(*least, kShares, "the least share of elements with depth, 0 to 1", diagnostics_)
            .value_or(0.0);
  }
}

// The object of a sensor has the limits of any object.
void SensorReader::read_object(MapReader& map, Object& object, bool& groups_known) const {
  object.margin = defaults_.margin;
  object.age_limit_ns = kAgeLimitNs;
  object.may_jump = true;
  if (const YamlNode* groups = map.optional("groups"))
    groups_known = read_groups(*groups, object.groups, diagnostics_);
  if (const YamlNode* margin = map.optional("margin"))
    object.margin = quantities_.length(*margin, "the margin", kNotNegative).value_or(0.0);
  if (const YamlNode* age = map.optional("age_limit_ms")) {
    object.age_limit_ns =
        quantities_.milliseconds(*age, "the age limit", kPositive).value_or(kAgeLimitNs);
  }
  if (const YamlNode* speed = map.optional("max_speed")) {
    object.max_speed =
        quantities_.speed(*speed, "the largest speed of what the sensor sees").value_or(kInfinity);
  }
}

void SensorReader::read(const YamlNode& node, SensorList& list, ObjectList& objects) {
  Sensor sensor;
  Object object;
  MapReader map(node, "a sensor", diagnostics_);
  const YamlNode* name_node = map.required("name");
  const auto name =
      name_node == nullptr ? std::nullopt : read_name(*name_node, "a sensor's name", diagnostics_);
  bool groups_known = true;
  read_topics(node, map, sensor);
  if (sensor.kind == SensorKind::kOctomap) {
    sensor.greatest_depth = kMapRange;
    if (const YamlNode* range = map.optional("range")) {
      sensor.greatest_depth =
          std::min(quantities_.length(*range, "the range of a map", kPositive).value_or(kMapRange),
                   kDepths.most);
    }
  } else {
    read_error(map, sensor);
    if (const YamlNode* range = map.required("range")) read_range(*range, sensor);
    refuse_large_error(node, sensor);
  }
  read_capacity(map, sensor);
  read_points(map, sensor);
  read_shell(map, sensor);
  read_liveness(map, sensor);
  if (const YamlNode* rate = map.optional("most_hz")) {
    const auto hz =
        read_number(*rate, kFrameRates, "the largest rate of frames in Hz", diagnostics_);
    if (hz) sensor.least_interval_ns = static_cast<std::int64_t>(1e9 / *hz);
  }
  if (const YamlNode* stamps = map.optional("stamps"))
    sensor.stamps = read_stamps(*stamps, diagnostics_);
  if (const YamlNode* error = map.optional("stamp_error_ms")) {
    const auto ms = read_number(*error, kStampErrors, "how far a stamp is off in ms", diagnostics_);
    if (ms) sensor.stamp_error_ns = static_cast<std::int64_t>(std::ceil(1e6 * *ms));
  }
  if (const YamlNode* witness = map.optional("witness"))
    read_witness(*witness, diagnostics_, sensor);
  if (const YamlNode* unseen = map.optional("unseen")) {
    sensor.unseen = read_flag(*unseen, diagnostics_).value_or(false);
    if (sensor.unseen && sensor.kind != SensorKind::kDepthImage)
      diagnostics_.add(*unseen, why_not_unseen(sensor.kind));
  }
  if (const YamlNode* reach = map.optional("reach")) {
    sensor.reach = quantities_.length(*reach, "the reach of the links", kNotNegative).value_or(0.0);
  }
  list.reaches.push_back(map.optional("reach"));
  const YamlNode* persist = map.optional("persist");
  if (persist != nullptr) read_persistence(*persist, diagnostics_, sensor);
  read_object(map, object, groups_known);
  if (persist != nullptr && object.max_speed == kInfinity) {
    diagnostics_.add(*persist,
                     "found 'persist' without 'max_speed'; expected both: how far may "
                     "something move from one frame to the next?");
  }
  list.mounts.push_back(map.optional("mount"));
  map.refuse_unknown_keys();
  sensor.name = object.name = name.value_or("");
  sensor.object = static_cast<std::uint32_t>(objects.objects.size());
  object.sensor = static_cast<std::uint32_t>(list.sensors.size());
  // Any ball would do for a sensor with a mistake.
  const double radius = std::max(sensor.view_radius(), 1.0);
  object.parts.push_back({.name = "view",
                          .shape = std::get<ConvexBody>(point(Vec3::Zero(), radius)),
                          .object_from_part = {}});
  objects.names_known = objects.names_known && name.has_value() && groups_known;
  objects.objects.push_back(std::move(object));
  objects.places.push_back(name_node == nullptr ? &node : name_node);
  list.sensors.push_back(std::move(sensor));
}

}  // namespace

SensorList read_sensors(const YamlNode& node, const ObjectDefaults& defaults,
                        const Quantities& quantities, ObjectList& objects) {
  Diagnostics& diagnostics = quantities.diagnostics();
  SensorList list;
  const std::vector<YamlNode>& items = read_list(node, "sensors", diagnostics);
  if (items.size() > kMaxSensors) {
    diagnostics.add(items[kMaxSensors], fmt::format("found {} sensors; expected at most {}",
                                                    items.size(), kMaxSensors));
    objects.names_known = false;
    return list;
  }
  SensorReader reader(defaults, quantities);
  for (const YamlNode& item : items) reader.read(item, list, objects);
  if (node.kind != YamlNode::Kind::kSequence) objects.names_known = false;
  return list;
}

}  // namespace clearance
