// Expands xacro by the program of that name, which comes with ROS 2.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace clearance {

[[nodiscard]] bool is_xacro(const std::filesystem::path& file);

// The name of the URDF that an xacro file becomes: of a.urdf.xacro and of a.xacro, a.urdf.
[[nodiscard]] std::filesystem::path expanded_name(const std::filesystem::path& xacro);

// Writes `urdf`; `arguments` are NAME:=VALUE. Returns the fault, or an empty text.
[[nodiscard]] std::string expand_xacro(const std::filesystem::path& xacro,
                                       const std::vector<std::string>& arguments,
                                       const std::filesystem::path& urdf);

}  // namespace clearance
