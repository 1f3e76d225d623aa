// Reads lengths, angles, directions and poses of a cell file in the units that it states, and
// returns them in SI units.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "config/yaml/diagnostics.hpp"
#include "config/yaml/scalar.hpp"
#include "config/yaml/yaml_node.hpp"
#include "core/pose.hpp"

namespace clearance {

// The units that a cell file may state.
enum class LengthUnit : std::uint8_t { kMetre, kMillimetre };
enum class AngleUnit : std::uint8_t { kRadian, kDegree };

// The largest coordinate of a cell, and the longest distance that a stated speed may cover in one
// second. Larger ones are mistakes of units.
inline constexpr double kMaxLength = 1e6;  // m

// A quaternion typed with this many digits is meant to be a unit one; farther off it is a mistake.
inline constexpr double kTypedUnitTolerance = 1e-3;

// The `units:` section.
struct Units {
  LengthUnit length = LengthUnit::kMetre;
  AngleUnit angle = AngleUnit::kRadian;
};

// Reads "m" or "mm"; "rad" or "deg". Returns nothing after a diagnostic.
[[nodiscard]] std::optional<LengthUnit> read_length_unit(const YamlNode& node,
                                                         Diagnostics& diagnostics);
[[nodiscard]] std::optional<AngleUnit> read_angle_unit(const YamlNode& node,
                                                       Diagnostics& diagnostics);

// Converts a length in this unit into metres.
[[nodiscard]] double to_metres(double value, LengthUnit unit);

// Every reading function returns nothing after a diagnostic. `what` names the quantity: "the
// radius".
class Quantities {
 public:
  Quantities(const Units& units, Diagnostics& diagnostics)
      : units_(units), diagnostics_(diagnostics) {}

  // For readers of shapes that state a unit of their own.
  [[nodiscard]] const Units& units() const { return units_; }
  [[nodiscard]] Diagnostics& diagnostics() const { return diagnostics_; }

  // The range is in the unit of the file.
  [[nodiscard]] std::optional<double> length(const YamlNode& node, const std::string& what,
                                             const Range& range = {}) const;  // m
  [[nodiscard]] std::optional<double> angle(const YamlNode& node,
                                            const std::string& what) const;  // rad
  // Angles per second, positive; rad/s.
  [[nodiscard]] std::optional<double> turn_speed(const YamlNode& node,
                                                 const std::string& what) const;
  [[nodiscard]] std::optional<double> speed(const YamlNode& node,
                                            const std::string& what) const;  // m/s
  [[nodiscard]] std::optional<double> acceleration(const YamlNode& node,
                                                   const std::string& what) const;  // m/s2
  // Returns ns; at most a day.
  [[nodiscard]] std::optional<std::int64_t> milliseconds(const YamlNode& node,
                                                         const std::string& what,
                                                         const Range& range) const;

  [[nodiscard]] std::optional<Vec3> lengths(const YamlNode& node, const std::string& what,
                                            const Range& range = {}) const;  // m
  [[nodiscard]] std::optional<Vec3> angles(const YamlNode& node,
                                           const std::string& what) const;  // rad
  [[nodiscard]] std::optional<Vec2> lengths_2d(const YamlNode& node,
                                               const std::string& what) const;  // m
  // Numbers without a unit, not all zero; not normalised.
  [[nodiscard]] std::optional<Vec3> direction(const YamlNode& node, const std::string& what) const;

  // {xyz: [x, y, z], rpy: [roll, pitch, yaw]} or {xyz: ..., quaternion: [x, y, z, w]}; each key may
  // be absent. rpy rotates about the fixed axes x, then y, then z, as in URDF. Right angles in
  // degrees are exact.
  [[nodiscard]] std::optional<Pose> pose(const YamlNode& node) const;

 private:
  [[nodiscard]] std::optional<Eigen::Quaterniond> rpy(const YamlNode& node) const;
  [[nodiscard]] std::optional<Eigen::Quaterniond> quaternion(const YamlNode& node) const;

  Units units_;
  Diagnostics& diagnostics_;
};

}  // namespace clearance
