#include "tools/robot/simulated_cameras.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <utility>

#include "monitor/loop/realtime.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
// A camera starts later than the robot: its first frame shows a robot whose joints are known.
constexpr std::int64_t kWarmUpNs = kSecondNs;
constexpr std::uint32_t kPointStep = 16;  // bytes: x, y, z and padding, as drivers send it
constexpr std::uint8_t kFloat32 = 7;

// Half the angle between the left and the right side of a picture, 60 degrees.
const double kViewTangent = std::tan(std::numbers::pi / 6.0);

// Points that state the spacing of their rays come from a picture with that spacing.
PinholeCamera camera_of(const Sensor& sensor, const SimulatedCameraOptions& options) {
  const double columns = options.columns;
  const double focal = sensor.kind == SensorKind::kPoints && sensor.spacing > 0.0
                           ? 1.0 / sensor.spacing
                           : 0.5 * columns / kViewTangent;
  return {.width = options.columns,
          .height = options.rows,
          .fx = focal,
          .fy = focal,
          .cx = 0.5 * (columns - 1.0),
          .cy = 0.5 * (options.rows - 1.0)};
}

// A depth image is 16UC1, in mm, unless half of its step exceeds the error that the cell states.
DepthImage::Format format_of(const Sensor& sensor) {
  const bool is_fine = sensor.error_at(sensor.least_depth) < 0.0005;
  return sensor.kind == SensorKind::kDepthImage && !is_fine ? DepthImage::Format::kMillimetres16
                                                            : DepthImage::Format::kMetres32;
}

void set_header(std_msgs_msg_dds__Header_& header, std::int64_t stamp_ns) {
  header.stamp.sec = static_cast<std::int32_t>(stamp_ns / kSecondNs);
  header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % kSecondNs);
}

void set_field(sensor_msgs_msg_dds__PointField_& field, const char* name, std::uint32_t offset) {
  field.name = dds_string_dup(name);
  field.offset = offset;
  field.datatype = kFloat32;
  field.count = 1;
}

}  // namespace

std::string fault_of(const Cell& cell, const SimulatedCameraOptions& options) {
  const std::size_t pixels = std::size_t{options.columns} * options.rows;
  for (const Sensor& sensor : cell.scene.sensors) {
    const PinholeCamera camera = camera_of(sensor, options);
    const double wide = 0.5 * std::max(options.columns, options.rows) / camera.fx;
    const bool is_image = sensor.kind == SensorKind::kDepthImage;
    if (!has_place(cell, sensor)) {
      return fmt::format(
          "the cell does not state where {} is; expected `mount` with a pose in the world, or on "
          "an object or link, or a mover of `simulation` with the frame {}",
          sensor.name, frame_of(sensor));
    }
    if (is_image ? options.columns > sensor.columns || options.rows > sensor.rows
                 : pixels > sensor.most_points) {
      return fmt::format("{} x {} pixels are more than the cell allows {}", options.columns,
                         options.rows, sensor.name);
    }
    if (wide > kWidestTangent) {
      return fmt::format(
          "the picture of {} is too wide: a side ray is {:.0f} degrees off the axis; "
          "expected at most 51",
          sensor.name, std::atan(wide) * 180.0 / std::numbers::pi);
    }
  }
  return {};
}

struct SimulatedCameras::Camera {
  Camera(std::uint32_t the_index, const Sensor& the_sensor, Participant& participant,
         const SimulatedCameraOptions& options);
  ~Camera() {
    for (const dds_entity_t writer : {frames, infos}) {
      if (writer != 0) dds_delete(writer);
    }
  }
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;

  [[nodiscard]] bool is_image() const { return sensor.kind == SensorKind::kDepthImage; }

  std::uint32_t index;
  const Sensor& sensor;
  rendering::DepthRenderer renderer;
  rendering::DepthNoise noise;
  DepthImage::Format format;
  std::vector<double> lengths;  // of the rays of depth 1
  std::vector<std::byte> bytes;
  std::vector<bool> is_sent;
  dds_entity_t frames = 0, infos = 0;
  Sample<sensor_msgs_msg_dds__Image_> image;
  Sample<sensor_msgs_msg_dds__CameraInfo_> info;
  Sample<sensor_msgs_msg_dds__PointCloud2_> points;

 private:
  void make_image();
  void make_info();
  void make_points();
};

SimulatedCameras::Camera::Camera(std::uint32_t the_index, const Sensor& the_sensor,
                                 Participant& participant, const SimulatedCameraOptions& options)
    : index(the_index),
      sensor(the_sensor),
      renderer(camera_of(the_sensor, options)),
      noise{
          .bound = {.constant = the_sensor.error_constant, .quadratic = the_sensor.error_quadratic},
          .range = {.least = the_sensor.least_depth, .greatest = the_sensor.greatest_depth},
          .share = options.noise_share,
          .missing_share = options.missing_share,
          .seed = 1 + the_index},
      format(format_of(the_sensor)),
      is_sent(renderer.depth().size()) {
  const std::string topic = ros_dds_name(sensor.topic);
  if (is_image()) {
    frames = participant.ros_writer(kRosImage, topic);
    infos = participant.ros_writer(kRosCameraInfo, ros_dds_name(sensor.camera_info));
    make_image();
    make_info();
  } else {
    frames = participant.ros_writer(kRosPointCloud2, topic);
    make_points();
  }
  if (!sensor.along_ray) return;
  const PinholeCamera& camera = renderer.camera();
  for (std::uint32_t v = 0; v < camera.height; ++v) {
    for (std::uint32_t u = 0; u < camera.width; ++u) {
      lengths.push_back(Vec3((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0).norm());
    }
  }
}

void SimulatedCameras::Camera::make_image() {
  const PinholeCamera& camera = renderer.camera();
  const bool is_16 = format == DepthImage::Format::kMillimetres16;
  image->header.frame_id = dds_string_dup(sensor.name.c_str());
  image->height = camera.height;
  image->width = camera.width;
  image->encoding = dds_string_dup(is_16 ? "16UC1" : "32FC1");
  image->step = camera.width * (is_16 ? 2U : 4U);
  reserve_sequence(image->data, std::size_t{image->step} * camera.height);
  image->data._length = image->data._maximum;
}

void SimulatedCameras::Camera::make_info() {
  const PinholeCamera& camera = renderer.camera();
  info->header.frame_id = dds_string_dup(sensor.name.c_str());
  info->height = camera.height;
  info->width = camera.width;
  info->distortion_model = dds_string_dup("plumb_bob");
  reserve_sequence(info->d, 5);
  info->d._length = 5;
  info->k[0] = info->p[0] = camera.fx;
  info->k[4] = info->p[5] = camera.fy;
  info->k[2] = info->p[2] = camera.cx;
  info->k[5] = info->p[6] = camera.cy;
  info->k[8] = info->p[10] = info->r[0] = info->r[4] = info->r[8] = 1.0;
}

void SimulatedCameras::Camera::make_points() {
  const PinholeCamera& camera = renderer.camera();
  points->header.frame_id = dds_string_dup(sensor.name.c_str());
  points->height = camera.height;
  points->width = camera.width;
  points->point_step = kPointStep;
  points->row_step = kPointStep * camera.width;
  reserve_sequence(points->fields, 3);
  points->fields._length = 3;
  set_field(points->fields._buffer[0], "x", 0);
  set_field(points->fields._buffer[1], "y", 4);
  set_field(points->fields._buffer[2], "z", 8);
  reserve_sequence(points->data, std::size_t{points->row_step} * camera.height);
  points->data._length = points->data._maximum;
}

SimulatedCameras::SimulatedCameras(const Cell& cell, Participant& participant, SimulatedWorld world,
                                   const SimulationTime& time,
                                   const SimulatedCameraOptions& options, Watch watch)
    : time_(time), options_(options), watch_(std::move(watch)), world_(std::move(world)) {
  for (std::uint32_t i = 0; i < cell.scene.sensors.size(); ++i) {
    cameras_.push_back(std::make_unique<Camera>(i, cell.scene.sensors[i], participant, options_));
  }
  thread_ = std::thread([this] { run(); });
}

SimulatedCameras::~SimulatedCameras() { stop(); }

void SimulatedCameras::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

// Frames at absolute deadlines. All cameras expose at the same time; late ones are left out.
void SimulatedCameras::run() {
  name_thread("cameras");
  SystemClock clock;
  const std::int64_t period_ns = std::llround(1e9 / options_.rate_hz);
  std::int64_t deadline = clock.monotonic_ns() + kWarmUpNs;
  while (!stop_) {
    clock.sleep_until(deadline);
    const std::int64_t now = clock.monotonic_ns();
    world_.place(time_.seconds(now));
    for (const std::unique_ptr<Camera>& camera : cameras_) expose(*camera, now);
    ++frame_;
    const std::int64_t passed = clock.monotonic_ns() - deadline;
    deadline += period_ns * std::max<std::int64_t>(1, passed / period_ns);
  }
}

void SimulatedCameras::expose(Camera& camera, std::int64_t monotonic_ns) {
  const std::optional<Pose> place = world_.sensor(camera.sensor);
  if (!place) return;
  SystemClock clock;
  const std::int64_t stamp_ns = time_.stamp(monotonic_ns);
  camera.renderer.render(*place, world_.bodies());
  measure(camera);
  rendered_.add(clock.monotonic_ns() - monotonic_ns);
  if (watch_) {
    watch_({.sensor = camera.index,
            .stamp_ns = stamp_ns,
            .t_s = time_.seconds(monotonic_ns),
            .world = world_,
            .world_from_sensor = *place,
            .truth = camera.renderer,
            .is_sent = camera.is_sent});
  }
  camera.is_image() ? write_image(camera, stamp_ns) : write_points(camera, stamp_ns);
  written_.add(clock.monotonic_ns() - monotonic_ns);
}

void SimulatedCameras::measure(Camera& camera) {
  std::span<const double> depth = camera.renderer.depth();
  if (camera.sensor.along_ray) {
    measured_.resize(depth.size());
    for (std::size_t i = 0; i < depth.size(); ++i) measured_[i] = depth[i] * camera.lengths[i];
    depth = measured_;
  }
  rendering::measure(depth, camera.format, camera.noise, frame_, camera.bytes);
  const bool is_16 = camera.format == DepthImage::Format::kMillimetres16;
  for (std::size_t i = 0; i < camera.is_sent.size(); ++i) {
    std::uint16_t millimetres = 0;
    float metres = 0.0F;
    if (is_16) {
      std::memcpy(&millimetres, &camera.bytes[2 * i], 2);
    } else {
      std::memcpy(&metres, &camera.bytes[4 * i], 4);
    }
    camera.is_sent[i] = is_16 ? millimetres != 0 : !std::isnan(metres);
  }
}

void SimulatedCameras::count(dds_return_t written) {
  ++sent_;
  failed_ += written != DDS_RETCODE_OK;
}

void SimulatedCameras::write_image(Camera& camera, std::int64_t stamp_ns) {
  set_header(camera.image->header, stamp_ns);
  set_header(camera.info->header, stamp_ns);
  std::memcpy(camera.image->data._buffer, camera.bytes.data(), camera.bytes.size());
  const dds_return_t image = dds_write(camera.frames, &*camera.image);
  const dds_return_t info = dds_write(camera.infos, &*camera.info);
  count(image != DDS_RETCODE_OK ? image : info);
}

void SimulatedCameras::write_points(Camera& camera, std::int64_t stamp_ns) {
  set_header(camera.points->header, stamp_ns);
  const PinholeCamera& pinhole = camera.renderer.camera();
  for (std::size_t i = 0; i < camera.is_sent.size(); ++i) {
    float depth = 0.0F;
    std::memcpy(&depth, &camera.bytes[4 * i], sizeof depth);
    const double z = camera.sensor.along_ray ? depth / camera.lengths[i] : double{depth};
    const double u = static_cast<double>(i % pinhole.width);
    const double v = static_cast<double>(i / pinhole.width);
    const float point[3] = {static_cast<float>((u - pinhole.cx) * z / pinhole.fx),
                            static_cast<float>((v - pinhole.cy) * z / pinhole.fy),
                            static_cast<float>(z)};
    std::memcpy(camera.points->data._buffer + i * kPointStep, point, sizeof point);
  }
  count(dds_write(camera.frames, &*camera.points));
}

}  // namespace clearance
