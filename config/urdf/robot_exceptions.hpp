// The pairs of a robot's links that a cell leaves out: those of its SRDF, or else its neighbours.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "config/urdf/urdf.hpp"

namespace clearance {

using LinkNames = std::set<std::string>;

// Returns the faults of an SRDF of another robot: links that the URDF does not have. If there
// are any, another name of the robot is a fault as well. Otherwise it is a note of the SRDF.
[[nodiscard]] UrdfFaults faults_of(Srdf& srdf, const std::filesystem::path& srdf_file,
                                   const UrdfRobot& robot, const std::filesystem::path& urdf_file);

// Names the links that have visual shapes only: nothing watches them.
void note_visuals(const UrdfRobot& robot, std::vector<std::string>& notes);

// Returns the pairs that the SRDF disables and a cell would watch: different links with shapes, not
// both fixed, each pair once. The notes tell which were left out.
[[nodiscard]] std::vector<SrdfDisabled> exceptions_of(const Srdf& srdf, const LinkNames& shaped,
                                                      const LinkNames& fixed,
                                                      std::vector<std::string>& notes);

// Returns each link with shapes with the next above it that has some, unless both are fixed; the
// notes name them.
[[nodiscard]] std::vector<SrdfDisabled> neighbours_of(const UrdfRobot& robot,
                                                      const LinkNames& shaped,
                                                      const LinkNames& fixed,
                                                      std::vector<std::string>& notes);

}  // namespace clearance
