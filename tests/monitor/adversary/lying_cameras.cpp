// What the cameras and the map of the cell of inputs that lie send.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/monitor/adversary/lying_senders.hpp"
#include "tests/monitor/intake/camera_texts.hpp"
#include "tests/shared/one_cube.hpp"

namespace clearance::test::lies {
namespace {

constexpr double kNoise = 0.004;       // m, of the picture; the cell states 0.01 m
constexpr double kDeepest = 65'535.0;  // of a pixel, mm

// The plate through the noise of its time. The same time gives the same picture.
std::vector<std::uint16_t> picture_of(std::int64_t t, const Told& told) {
  Random noise(static_cast<std::uint64_t>(t));
  std::vector<std::uint16_t> depths(std::size_t{kRows} * kColumns);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double depth = static_cast<double>(TrueMotion::plate_depth(t)) + told.offset.z() +
                         noise.uniform(-kNoise, kNoise);
    const bool is_missing = told.is_nan || (told.is_torn && 2 * i >= depths.size());
    const double millimetres = std::clamp(1000.0 * told.length_scale * depth, 0.0, kDeepest);
    depths[i] = is_missing ? 0 : static_cast<std::uint16_t>(std::lround(millimetres));
  }
  return depths;
}

std::vector<std::byte> cdr_of(const std::vector<std::uint16_t>& depths, std::int64_t stamp_ns,
                              const std::string& frame, bool are_floats, bool is_padded) {
  camera::ImageText image;
  image.height = kRows, image.width = kColumns;
  image.step = 2 * kColumns * (are_floats || is_padded ? 2 : 1);
  image.data.assign(std::size_t{image.height} * image.step, 0);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    std::uint8_t* const row = image.data.data() + i / kColumns * image.step;
    const float metres = 0.001F * static_cast<float>(depths[i]);
    if (are_floats) {
      std::memcpy(row + i % kColumns * sizeof metres, &metres, sizeof metres);
    } else {
      std::memcpy(row + i % kColumns * sizeof depths[i], &depths[i], sizeof depths[i]);
    }
  }
  image.stamp_ns = stamp_ns;
  image.frame = frame;
  return image.cdr();
}

// Two rows of two points.
std::vector<std::byte> cdr_of(const std::array<Eigen::Vector3f, kSeenPoints>& points,
                              std::int64_t stamp_ns, const std::string& frame,
                              bool has_other_layout, bool is_padded) {
  camera::CloudText cloud;
  cloud.width = cloud.height = 2;
  cloud.row_step = (is_padded ? 2 : 1) * cloud.width * cloud.point_step;
  cloud.data.assign(cloud.height * cloud.row_step, 0);
  for (std::size_t i = 0; i < kSeenPoints; ++i) {
    std::memcpy(cloud.data.data() + i / 2 * cloud.row_step + i % 2 * cloud.point_step,
                points[i].data(), 3 * sizeof(float));
  }
  if (has_other_layout) cloud.fields[1].offset = cloud.fields[2].offset = 0;
  cloud.stamp_ns = stamp_ns;
  cloud.frame = frame;
  return cloud.cdr();
}

}  // namespace

void LyingSenders::see(Channel channel, const Told& told, std::int64_t t, Words& words) const {
  words.has_other_layout = told.has_other_layout;
  words.is_padded = told.is_padded;
  words.is_torn = told.is_torn;
  words.parent = told.is_far ? "far" : channel == Channel::kPoints ? "eye_link" : name(channel);
  if (channel == Channel::kPicture) {
    words.depths = picture_of(told.value_at, told);
    if (told.goes_on_a_little) words.depths[0] = picture_of(t, told)[0];
    return;
  }
  if (channel == Channel::kMap) {
    const TruePoint place(kMapPlace[0], kMapPlace[1], kMapPlace[2]);
    words.walker = TrueMotion::walker(told.value_at) + told.offset.cast<long double>() - place;
    words.scale = told.length_scale;
    words.is_empty = told.is_nan;
    return;
  }
  const TruePose eye = truth_.pose(Channel::kEye, told.value_at);
  for (std::size_t i = 0; i < kSeenPoints; ++i) {
    const TruePoint off = TrueMotion::seen_points()[i] - eye.col(3).head<3>();
    const TruePoint seen =
        (eye.topLeftCorner<3, 3>().transpose() * off + told.offset.cast<long double>()) *
        told.length_scale;
    const bool is_missing = told.is_nan || (told.is_torn && i + 1 < kSeenPoints);
    words.points[i] =
        is_missing ? Eigen::Vector3f::Constant(std::nanf("")) : Eigen::Vector3f(seen.cast<float>());
  }
}

LyingSenders::Message LyingSenders::seen(Channel channel, const Words& words) {
  if (channel == Channel::kPoints) {
    return message_of("/eye/points", "sensor_msgs/msg/PointCloud2",
                      cdr_of(words.points, words.stamp_ns, words.parent, words.has_other_layout,
                             words.is_padded));
  }
  if (channel == Channel::kPicture) {
    return message_of("/lens/image", "sensor_msgs/msg/Image",
                      cdr_of(words.depths, words.stamp_ns, words.parent, words.has_other_layout,
                             words.is_padded));
  }
  std::array<unsigned, 3> cube{};
  for (std::size_t i = 0; i < 3; ++i) {
    const long double at = std::max(words.walker[static_cast<Eigen::Index>(i)], 0.0L);
    cube[i] = static_cast<unsigned>(at / kCube);
  }
  std::string tree = words.is_empty ? "" : one_cube(cube);
  if (words.is_torn) tree.resize(tree.size() / 2 + 1);
  return message_of(
      "/map", "octomap_msgs/msg/Octomap",
      camera::map_cdr(tree, words.stamp_ns, words.has_other_layout ? "SemanticOcTree" : "OcTree",
                      words.parent, (words.is_padded ? 2.0 : words.scale) * kCube));
}

// Comes once: the lens keeps its form.
LyingSenders::Message LyingSenders::camera_info(std::int64_t t) {
  camera::InfoText info;
  info.width = kColumns, info.height = kRows;
  const double x = 0.5 * (kColumns - 1), y = 0.5 * (kRows - 1);
  info.k = {kFocal, 0, x, 0, kFocal, y, 0, 0, 1};
  info.p = {kFocal, 0, x, 0, 0, kFocal, y, 0, 0, 0, 1, 0};
  info.frame = name(Channel::kPicture);
  info.stamp_ns = start_ns_ + t;
  Message made = message_of("/lens/camera_info", "sensor_msgs/msg/CameraInfo", info.cdr());
  made.due = t;
  made.sent_ns = info.stamp_ns;
  made.writer = kCameraDriver;
  return made;
}

LyingSenders::Message LyingSenders::message_of(const char* name, const char* type,
                                               const std::vector<std::byte>& cdr) {
  Message made;
  made.topic = topic(name, type);
  made.cdr = cdr;
  return made;
}

}  // namespace clearance::test::lies
