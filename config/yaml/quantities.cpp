// Every number is checked in the unit of the file and converted afterwards, so that messages show
// what the person wrote. Limits are converted into that unit, too.
#include "config/yaml/quantities.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "config/yaml/map_reader.hpp"

namespace clearance {
namespace {

// A longer time limit is a mistake, and a day in ns is far below the range of its type.
constexpr double kMaxMilliseconds = 86'400'000.0;  // a day
constexpr double kRadPerDeg = std::numbers::pi / 180.0;

// Reads a list of N numbers, each checked; returns nothing when one of them, or their count, is
// wrong.
template <std::size_t N>
std::optional<std::array<double, N>> numbers(const YamlNode& node, const std::string& what,
                                             const std::string& each, const Range& range,
                                             Diagnostics& diagnostics) {
  if (node.kind != YamlNode::Kind::kSequence || node.items.size() != N) {
    diagnostics.add(
        node, fmt::format("found {}; expected {}, a list of {} numbers", describe(node), what, N));
    return std::nullopt;
  }
  std::array<double, N> values{};
  bool good = true;
  for (std::size_t i = 0; i < N; ++i) {
    const auto value = read_number(node.items[i], range, each, diagnostics);
    good = good && value.has_value();
    values[i] = value.value_or(0.0);
  }
  return good ? std::optional(values) : std::nullopt;
}

// The names of units in messages.
const char* word(LengthUnit unit) { return unit == LengthUnit::kMetre ? "m" : "mm"; }
const char* word(AngleUnit unit) { return unit == AngleUnit::kRadian ? "rad" : "deg"; }

// Multiples of 90 deg in a pose are handled by turn(), exactly.
double radians(double value, AngleUnit unit) {
  return unit == AngleUnit::kRadian ? value : value * kRadPerDeg;
}

// Returns the rotation about one axis, not normalised. Right angles in degrees have whole
// components, so that their products are exact and parallel faces stay parallel.
Eigen::Quaterniond turn(double value, AngleUnit unit, const Vec3& axis) {
  if (unit == AngleUnit::kDegree && std::fmod(value, 90.0) == 0.0) {
    switch (static_cast<int>(std::fmod(value, 360.0)) / 90) {
      case 1:
      case -3:
        return Eigen::Quaterniond(1.0, axis.x(), axis.y(), axis.z());
      case 2:
      case -2:
        return Eigen::Quaterniond(0.0, axis.x(), axis.y(), axis.z());
      case 3:
      case -1:
        return Eigen::Quaterniond(1.0, -axis.x(), -axis.y(), -axis.z());
      default:
        return Eigen::Quaterniond::Identity();
    }
  }
  return Eigen::Quaterniond(Eigen::AngleAxisd(radians(value, unit), axis));
}

// No length may exceed kMaxLength, which keeps rounding errors far below the gap tolerance.
Range within_cell(const Range& range, LengthUnit unit) {
  const double most = unit == LengthUnit::kMetre ? kMaxLength : kMaxLength * 1000.0;
  return {std::fmax(range.least, -most), std::fmin(range.most, most), range.above_least};
}

}  // namespace

std::optional<LengthUnit> read_length_unit(const YamlNode& node, Diagnostics& diagnostics) {
  if (node.kind == YamlNode::Kind::kScalar && node.text == "m") return LengthUnit::kMetre;
  if (node.kind == YamlNode::Kind::kScalar && node.text == "mm") return LengthUnit::kMillimetre;
  diagnostics.add(node,
                  fmt::format("found {}; expected the unit of length, m or mm", describe(node)));
  return std::nullopt;
}

std::optional<AngleUnit> read_angle_unit(const YamlNode& node, Diagnostics& diagnostics) {
  if (node.kind == YamlNode::Kind::kScalar && node.text == "rad") return AngleUnit::kRadian;
  if (node.kind == YamlNode::Kind::kScalar && node.text == "deg") return AngleUnit::kDegree;
  diagnostics.add(node,
                  fmt::format("found {}; expected the unit of angle, rad or deg", describe(node)));
  return std::nullopt;
}

// Division rounds once: 300 mm is exactly the double nearest to 0.3.
double to_metres(double value, LengthUnit unit) {
  return unit == LengthUnit::kMetre ? value : value / 1000.0;
}

std::optional<double> Quantities::length(const YamlNode& node, const std::string& what,
                                         const Range& range) const {
  const auto value = read_number(node, within_cell(range, units_.length),
                                 fmt::format("{} in {}", what, word(units_.length)), diagnostics_);
  return value ? std::optional(to_metres(*value, units_.length)) : std::nullopt;
}

// Degrees become radians here, with the rounding of one multiplication.
std::optional<double> Quantities::angle(const YamlNode& node, const std::string& what) const {
  const auto value =
      read_number(node, {}, fmt::format("{} in {}", what, word(units_.angle)), diagnostics_);
  return value ? std::optional(radians(*value, units_.angle)) : std::nullopt;
}

std::optional<double> Quantities::turn_speed(const YamlNode& node, const std::string& what) const {
  const auto value = read_number(node, kPositive,
                                 fmt::format("{} in {}/s", what, word(units_.angle)), diagnostics_);
  return value ? std::optional(radians(*value, units_.angle)) : std::nullopt;
}

// Lengths per second in the cell's unit become m/s.
std::optional<double> Quantities::speed(const YamlNode& node, const std::string& what) const {
  const auto value =
      read_number(node, within_cell(kPositive, units_.length),
                  fmt::format("{} in {}/s", what, word(units_.length)), diagnostics_);
  return value ? std::optional(to_metres(*value, units_.length)) : std::nullopt;
}

std::optional<double> Quantities::acceleration(const YamlNode& node,
                                               const std::string& what) const {
  const auto value =
      read_number(node, within_cell(kNotNegative, units_.length),
                  fmt::format("{} in {}/s2", what, word(units_.length)), diagnostics_);
  return value ? std::optional(to_metres(*value, units_.length)) : std::nullopt;
}

// Fractions of a millisecond are allowed; the result is rounded to whole nanoseconds.
std::optional<std::int64_t> Quantities::milliseconds(const YamlNode& node, const std::string& what,
                                                     const Range& range) const {
  const Range limited{range.least, std::fmin(range.most, kMaxMilliseconds), range.above_least};
  const auto value = read_number(node, limited, fmt::format("{} in ms", what), diagnostics_);
  return value ? std::optional<std::int64_t>(std::llround(*value * 1e6)) : std::nullopt;
}

// Each number is checked against the range on its own.
std::optional<Vec3> Quantities::lengths(const YamlNode& node, const std::string& what,
                                        const Range& range) const {
  const std::string unit = word(units_.length);
  const auto values =
      numbers<3>(node, fmt::format("{} in {}", what, unit), fmt::format("a length in {}", unit),
                 within_cell(range, units_.length), diagnostics_);
  if (!values) return std::nullopt;
  return Vec3(to_metres((*values)[0], units_.length), to_metres((*values)[1], units_.length),
              to_metres((*values)[2], units_.length));
}

// Angular velocities about the axes are read with this as well, in the angle's unit per second.
std::optional<Vec3> Quantities::angles(const YamlNode& node, const std::string& what) const {
  const std::string unit = word(units_.angle);
  const auto values = numbers<3>(node, fmt::format("{} in {}", what, unit),
                                 fmt::format("an angle in {}", unit), {}, diagnostics_);
  if (!values) return std::nullopt;
  return Vec3(radians((*values)[0], units_.angle), radians((*values)[1], units_.angle),
              radians((*values)[2], units_.angle));
}

// The vertices of the base of a prism are read with this.
std::optional<Vec2> Quantities::lengths_2d(const YamlNode& node, const std::string& what) const {
  const std::string unit = word(units_.length);
  const auto values =
      numbers<2>(node, fmt::format("{} in {}", what, unit), fmt::format("a length in {}", unit),
                 within_cell({}, units_.length), diagnostics_);
  if (!values) return std::nullopt;
  return Vec2(to_metres((*values)[0], units_.length), to_metres((*values)[1], units_.length));
}

// A normal may have any length but zero; the core normalises it.
std::optional<Vec3> Quantities::direction(const YamlNode& node, const std::string& what) const {
  const auto values = numbers<3>(node, what, "a number", {}, diagnostics_);
  if (!values) return std::nullopt;
  const Vec3 direction((*values)[0], (*values)[1], (*values)[2]);
  if (direction == Vec3::Zero()) {
    diagnostics_.add(node, fmt::format("found only zeros; expected {}, a direction", what));
    return std::nullopt;
  }
  return direction;
}

// Roll, pitch and yaw about the fixed axes x, y, z, as in URDF.
std::optional<Eigen::Quaterniond> Quantities::rpy(const YamlNode& node) const {
  const std::string unit = word(units_.angle);
  const auto values = numbers<3>(node, fmt::format("roll, pitch and yaw in {}", unit),
                                 fmt::format("an angle in {}", unit), {}, diagnostics_);
  if (!values) return std::nullopt;
  // Yaw after pitch after roll; normalised once, at the end, so that right angles stay exact.
  const Eigen::Quaterniond product = turn((*values)[2], units_.angle, Vec3::UnitZ()) *
                                     turn((*values)[1], units_.angle, Vec3::UnitY()) *
                                     turn((*values)[0], units_.angle, Vec3::UnitX());
  return product.normalized();
}

// Reads x, y, z, w and normalises them. A length far from 1 is a mistake, not a rounding error.
std::optional<Eigen::Quaterniond> Quantities::quaternion(const YamlNode& node) const {
  const auto values =
      numbers<4>(node, "a unit quaternion x, y, z, w", "a number", {}, diagnostics_);
  if (!values) return std::nullopt;
  const Eigen::Quaterniond found((*values)[3], (*values)[0], (*values)[1], (*values)[2]);
  if (!(std::fabs(found.norm() - 1.0) <= kTypedUnitTolerance)) {
    diagnostics_.add(
        node,
        fmt::format("found a quaternion of length {:f}; expected a unit quaternion x, y, z, w",
                    found.norm()));
    return std::nullopt;
  }
  return found.normalized();
}

// Position and orientation, either of which may be left out; two orientations are a mistake.
std::optional<Pose> Quantities::pose(const YamlNode& node) const {
  const std::size_t before = diagnostics_.count();
  MapReader map(node, "a pose", diagnostics_);
  const YamlNode* xyz = map.optional("xyz");
  const YamlNode* angles_node = map.optional("rpy");
  const YamlNode* quaternion_node = map.optional("quaternion");
  map.refuse_unknown_keys();
  if (angles_node != nullptr && quaternion_node != nullptr) {
    diagnostics_.add(*quaternion_node, "found a quaternion beside rpy; expected one of the two");
  }
  Pose pose;
  if (xyz != nullptr) pose.position = lengths(*xyz, "a position").value_or(Vec3::Zero());
  if (angles_node != nullptr) pose.orientation = rpy(*angles_node).value_or(pose.orientation);
  if (quaternion_node != nullptr) {
    pose.orientation = quaternion(*quaternion_node).value_or(pose.orientation);
  }
  return diagnostics_.count() == before ? std::optional(pose) : std::nullopt;
}

}  // namespace clearance
