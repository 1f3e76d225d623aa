// Which pairs of a robot's links a cell leaves out: those of its SRDF, or else its neighbours.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "config/urdf/urdf.hpp"

namespace clearance {

using LinkNames = std::set<std::string>;

// What is wrong with the SRDF as one of this robot: another name, links that the URDF does not
// have.
[[nodiscard]] UrdfFaults faults_of(const Srdf& srdf, const std::filesystem::path& srdf_file,
                                   const UrdfRobot& robot, const std::filesystem::path& urdf_file);

// The pairs that the SRDF disables and a cell would watch: of different links with shapes, not both
// fixed, each once. What was left out of them goes into the notes.
[[nodiscard]] std::vector<SrdfDisabled> exceptions_of(const Srdf& srdf, const LinkNames& shaped,
                                                      const LinkNames& fixed,
                                                      std::vector<std::string>& notes);

// Each link with shapes and the next above it that has some, not both fixed; the notes name them.
[[nodiscard]] std::vector<SrdfDisabled> neighbours_of(const UrdfRobot& robot,
                                                      const LinkNames& shaped,
                                                      const LinkNames& fixed,
                                                      std::vector<std::string>& notes);

}  // namespace clearance
