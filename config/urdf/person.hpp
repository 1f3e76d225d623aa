// A person as a robot: the skeleton of ROS4HRI (REP-155) with capsules for its limbs.
//
// Capsules and balls contain the body of nearly everyone whose joints are where the skeleton has
// them. Lengths are those of the skeleton. Girths depend little on stature, so a short person's
// limbs have the radii of a person of mean stature.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "config/urdf/urdf.hpp"

namespace clearance {

// The statures that are plausible, m.
inline constexpr double kLeastStature = 1.2, kMostStature = 2.3;

// The skeleton of a person of this stature, without shapes and with the names of REP-155. Segments
// are those of Drillis and Contini (1966): fractions of the stature. All angles are zero while the
// person stands upright, arms down, x forward and y to the left; its root is between the hips.
[[nodiscard]] UrdfRobot skeleton_of(double stature);

// Gives the links of a skeleton their capsules. Its root link is "body" or "body_ID", and all names
// end alike. Links then end with "_PERSON", joints with "_ID". Limits of joints are dropped: those
// of trackers are no limits of people. Returns what the skeleton lacks; nothing: it is one.
[[nodiscard]] std::optional<std::string> make_person(double stature, const std::string& person,
                                                     const std::string& id, UrdfRobot& skeleton);

// The speed with which a limb approaches (ISO 13855), m/s: that of arms, or of a walking person.
// `link` is the name with its ending.
[[nodiscard]] double approach_speed_of(std::string_view link) noexcept;

}  // namespace clearance
