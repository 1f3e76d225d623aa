#include "monitor/intake/camera_messages.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string_view>

#include "monitor/intake/layout.hpp"

namespace clearance {
namespace {

constexpr std::uint8_t kUint32 = 6, kFloat32 = 7, kFloat64 = 8;  // sensor_msgs/PointField
constexpr bool kIsBigEndian = std::endian::native == std::endian::big;

std::span<const std::byte> bytes_of(const dds_sequence_octet& data) noexcept {
  return std::as_bytes(std::span(data._buffer, data._length));
}

// Exactly one field of the name, a single float32 within the point.
bool find_field(const sensor_msgs_msg_dds__PointCloud2_& message, std::string_view name,
                std::size_t& offset) noexcept {
  std::size_t found = 0;
  for (std::uint32_t i = 0; i < message.fields._length; ++i) {
    const sensor_msgs_msg_dds__PointField_& field = message.fields._buffer[i];
    if (name != field.name) continue;
    // Some drivers write a count of 0 for one number.
    if (field.datatype != kFloat32 || field.count > 1) return false;
    if (std::uint64_t{field.offset} + sizeof(float) > message.point_step) return false;
    offset = field.offset;
    ++found;
  }
  return found == 1;
}

// Bytes of a number of each sensor_msgs/PointField; 0: not known.
constexpr std::array<std::uint8_t, 9> kFieldBytes{0, 1, 1, 2, 2, 4, 4, 4, 8};

// True if a field of another name shares bytes with the float32 at this offset.
bool is_shared(const sensor_msgs_msg_dds__PointCloud2_& message, std::string_view name,
               std::size_t offset) noexcept {
  const std::span fields(message.fields._buffer, message.fields._length);
  return std::ranges::any_of(fields, [&](const sensor_msgs_msg_dds__PointField_& field) {
    if (name == field.name || field.datatype >= kFieldBytes.size()) return false;
    const std::uint64_t bytes =
        std::uint64_t{kFieldBytes[field.datatype]} * std::max(field.count, 1U);
    return field.offset < offset + sizeof(float) && offset < field.offset + bytes;
  });
}

// The first field with a name that drivers of rotating sensors give to times. Returns false if its
// type does not tell its unit.
bool find_times(const sensor_msgs_msg_dds__PointCloud2_& message, PointsView& out) noexcept {
  constexpr std::array<std::string_view, 5> kNames{"t", "time", "timestamp", "time_stamp",
                                                   "offset_time"};
  const std::span fields(message.fields._buffer, message.fields._length);
  const auto found = std::ranges::find_if(fields, [&](const auto& field) {
    return std::ranges::find(kNames, std::string_view(field.name)) != kNames.end();
  });
  if (found == fields.end()) return true;
  using Times = PointsView::Times;
  const std::uint8_t type = found->datatype;
  out.times = type == kUint32    ? Times::kUint32
              : type == kFloat32 ? Times::kFloat32
              : type == kFloat64 ? Times::kFloat64
                                 : Times::kNotSent;
  out.time = found->offset;
  return out.times != Times::kNotSent && found->count <= 1 &&
         std::uint64_t{found->offset} + kFieldBytes[type] <= message.point_step;
}

bool is_identity_or_zero(const double (&r)[9]) noexcept {
  constexpr std::array<double, 9> kIdentity{1, 0, 0, 0, 1, 0, 0, 0, 1};
  return std::equal(kIdentity.begin(), kIdentity.end(), r) ||
         std::all_of(std::begin(r), std::end(r), [](double x) { return x == 0.0; });
}

// In the order of FrameFault.
struct FaultWords {
  FrameFault fault;
  const char* name;
  const char* text;
};
constexpr auto kWords = [] {
  using enum FrameFault;
  return std::array<FaultWords, kFrameFaults>{{
      {kNoFault, "", "nothing is wrong"},
      {kUndecodable, "bytes that are no frame", "the bytes are not a message of this type"},
      {kEncoding, "neither 16UC1 nor 32FC1", "the encoding is neither 16UC1 nor 32FC1"},
      {kByteOrder, "another byte order",
       "the byte order is not that of this machine, or not the one that it states"},
      {kNoPixels, "no pixels", "the width or height is 0"},
      {kTooManyPixels, "more pixels than the cell states",
       "it has more pixels than the cell states"},
      {kStep, "a step below a row", "the step is smaller than a row or a point"},
      {kShortData, "half a frame", "it has fewer bytes than its size says"},
      {kFields, "fields that are no points",
       "x, y and z are not one float32 each within the point, or a time is no uint32 or float"},
      {kLayout, "a layout that cannot be",
       "numbers overlap, or the rows or angles are not those of its numbers"},
      {kLongScan, "a scan longer than its stamp error",
       "its rays or points were measured over more time than 'stamp_error_ms' states"},
      {kIntrinsics, "no pinhole camera", "the intrinsics are not those of a pinhole camera"},
      {kDistorted, "not rectified",
       "it has a distortion, rotation, binning or region: use the rectified image"},
      {kNoCameraInfo, "no CameraInfo yet", "no CameraInfo has come yet"},
      {kCameraInfoChanged, "another CameraInfo than the first",
       "the CameraInfo differs from the first one"},
      {kSizeChanged, "another size than its CameraInfo", "its size is not that of the CameraInfo"},
      {kOtherCamera, "a CameraInfo of another frame", "its frame_id is not that of the CameraInfo"},
      {kNoStamp, "no stamp", "its stamp is 0"},
      {kOtherClock, "a stamp of another clock", "its stamp is of another clock"},
      {kOldStamp, "a stamp not newer than the last",
       "its stamp is not newer than that of the frame before"},
      {kFrozen, "frozen image",
       "its depth is that of one of the last frames, but for less than one element in fifty"},
      {kSecondPublisher, "a second publisher", "another publisher sends frames as well"},
      {kTooOften, "more often than the cell states", "frames come more often than the cell states"},
      {kFrameChanged, "another frame than the first",
       "its frame_id is not that of the first message that was used"},
      {kFormChanged, "another form than the first",
       "its encoding, size or fields are not those of the first message that was used"},
      {kNoPlace, "its place is not known", "the place of the sensor at its stamp is not known"},
      {kLateTransforms, "late transforms", "transforms up to its stamp have not come in time"},
      {kCannotBuild, "too wide, or too many points",
       "its picture is too wide, or has more points within the range than the cell states"},
      {kNothingSeen, "too little seen beside the robot",
       "nothing is seen within the range but the robot itself. Known bodies at their places do not "
       "fill a quarter of the picture, so nothing shows that the place is clear"},
      {kBeforeJoints, "before the first joints",
       "joints were first heard after its stamp: the robot's own image is not left out"},
      {kNotOrganised, "not organised", "it has no rows, so its points have no neighbours"},
      {kOctree, "a map that cannot be read",
       "its tree is cut, too deep, without a resolution, or neither OcTree nor ColorOcTree"},
      {kWideRays, "rays too far apart",
       "rays beside each other are more than 0.1 rad apart: of points, state 'spacing' as a "
       "number"},
      {kUnknownRays, "rays unknown",
       "no two points in one row, or none in one column, show how far apart its rays are"},
      {kFewSeen, "less seen than the cell states",
       "a smaller share of it has depth within the range than 'least_seen' states"},
      {kSeenFell, "far less seen than before",
       "far less of it has depth within the range than of the frame before: it may be torn"},
      {kRobotElsewhere, "tf has a robot elsewhere",
       "tf has the base of a robot elsewhere than the cell, so the sensor may be misplaced"},
      {kTooNear, "a point too near",
       "a coordinate is -infinity: a point is nearer than can be measured, and nothing says where"},
  }};
}();
static_assert([] {
  for (std::size_t i = 0; i < kWords.size(); ++i) {
    if (static_cast<std::size_t>(kWords[i].fault) != i) return false;
  }
  return true;
}());

}  // namespace

const char* text(FrameFault fault) noexcept { return kWords[static_cast<std::size_t>(fault)].text; }
const char* name(FrameFault fault) noexcept { return kWords[static_cast<std::size_t>(fault)].name; }

FrameFault view(const sensor_msgs_msg_dds__Image_& message, std::size_t most_pixels,
                DepthImage& out) noexcept {
  const std::string_view encoding = message.encoding;
  const bool is_millimetres = encoding == "16UC1";
  if (!is_millimetres && encoding != "32FC1") return FrameFault::kEncoding;
  if ((message.is_bigendian != 0) != kIsBigEndian) return FrameFault::kByteOrder;
  const std::span<const std::byte> bytes = bytes_of(message.data);
  const FrameFault fault =
      judge({.number = is_millimetres ? Layout::Number::kMillimetres16 : Layout::Number::kMetres32,
             .columns = message.width,
             .rows = message.height,
             .element_step = is_millimetres ? 2U : 4U,
             .row_step = message.step,
             .bytes = bytes},
            most_pixels);
  if (fault != FrameFault::kNoFault) return fault;
  out = {is_millimetres ? DepthImage::Format::kMillimetres16 : DepthImage::Format::kMetres32,
         message.width, message.height, message.step, bytes};
  return FrameFault::kNoFault;
}

FrameFault view(const sensor_msgs_msg_dds__PointCloud2_& message, std::size_t most_points,
                PointsView& out) noexcept {
  if (message.is_bigendian != kIsBigEndian) return FrameFault::kByteOrder;
  PointsView found;
  if (!find_field(message, "x", found.x) || !find_field(message, "y", found.y) ||
      !find_field(message, "z", found.z) || !find_times(message, found)) {
    return FrameFault::kFields;
  }
  // A row_step of 0 is common where there is one row.
  const std::uint64_t row = std::uint64_t{message.width} * message.point_step;
  const std::uint64_t step =
      message.height == 1 ? std::max<std::uint64_t>(row, message.row_step) : message.row_step;
  const std::span<const std::byte> bytes = bytes_of(message.data);
  const FrameFault fault = judge({.columns = message.width,
                                  .rows = message.height,
                                  .element_step = message.point_step,
                                  .row_step = step,
                                  .offsets = {found.x, found.y, found.z},
                                  .numbers = 3,
                                  .bytes = bytes},
                                 most_points);
  if (fault != FrameFault::kNoFault) return fault;
  if (is_shared(message, "x", found.x) || is_shared(message, "y", found.y) ||
      is_shared(message, "z", found.z)) {
    return FrameFault::kLayout;
  }
  found.width = message.width;
  found.height = message.height;
  found.point_step = message.point_step;
  found.row_step = step;
  found.bytes = bytes;
  out = found;
  return FrameFault::kNoFault;
}

FrameFault view(const octomap_msgs_msg_dds__Octomap_& message, OctomapView& out) noexcept {
  if (!(message.resolution > 0.0 && message.resolution <= kLargestResolution))
    return FrameFault::kOctree;
  out = {.is_binary = message.binary,
         .id = message.id,
         .resolution = message.resolution,
         .bytes = std::as_bytes(std::span(message.data._buffer, message.data._length))};
  return FrameFault::kNoFault;
}

// A rectified image follows P, a raw one K. Both are the same where nothing is distorted, so that
// no mistake between the two is possible.
FrameFault view(const sensor_msgs_msg_dds__CameraInfo_& message, PinholeCamera& out) noexcept {
  if (message.width == 0 || message.height == 0) return FrameFault::kNoPixels;
  const double* const k = message.k;
  const double* const p = message.p;
  for (std::uint32_t i = 0; i < message.d._length; ++i) {
    if (message.d._buffer[i] != 0.0) return FrameFault::kDistorted;  // NaN as well
  }
  const sensor_msgs_msg_dds__RegionOfInterest_& roi = message.roi;
  const bool is_whole = roi.x_offset == 0 && roi.y_offset == 0 &&
                        (roi.width == 0 || roi.width == message.width) &&
                        (roi.height == 0 || roi.height == message.height);
  if (!is_whole || message.binning_x > 1 || message.binning_y > 1 ||
      !is_identity_or_zero(message.r)) {
    return FrameFault::kDistorted;
  }
  const bool finite =
      std::isfinite(k[0]) && std::isfinite(k[2]) && std::isfinite(k[4]) && std::isfinite(k[5]);
  const bool is_pinhole = finite && k[0] > 0.0 && k[4] > 0.0 && k[1] == 0.0 && k[3] == 0.0 &&
                          k[6] == 0.0 && k[7] == 0.0 && k[8] == 1.0;
  const bool has_projection =
      std::any_of(message.p, message.p + 12, [](double x) { return x != 0.0; });
  const bool agrees =
      !has_projection ||
      (p[0] == k[0] && p[1] == 0.0 && p[2] == k[2] && p[3] == 0.0 && p[4] == 0.0 && p[5] == k[4] &&
       p[6] == k[5] && p[7] == 0.0 && p[8] == 0.0 && p[9] == 0.0 && p[10] == 1.0 && p[11] == 0.0);
  if (!is_pinhole || !agrees) return FrameFault::kIntrinsics;
  out = {message.width, message.height, k[0], k[4], k[2], k[5]};
  return FrameFault::kNoFault;
}

}  // namespace clearance
