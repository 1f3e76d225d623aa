#include "tools/scene/xacro.hpp"

#include <fmt/format.h>

#include "tools/shared/other_program.hpp"

namespace clearance {

bool is_xacro(const std::filesystem::path& file) { return file.extension() == ".xacro"; }

std::filesystem::path expanded_name(const std::filesystem::path& xacro) {
  const std::filesystem::path stem = xacro.stem();
  return (stem.extension() == ".urdf" ? stem.stem().string() : stem.string()) + ".urdf";
}

// An absolute path begins with no dash. It is written beside its final name, so that a file that is
// not whole has another one.
std::string expand_xacro(const std::filesystem::path& xacro,
                         const std::vector<std::string>& arguments,
                         const std::filesystem::path& urdf) {
  const std::string part = urdf.string() + ".part";
  std::vector<std::string> words = {"xacro", "-o", part, std::filesystem::absolute(xacro).string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const ProgramRun run = run_program(std::move(words));
  std::error_code fault;
  if (run.status == 0) std::filesystem::rename(part, urdf, fault);
  if (run.status == 0 && !fault) return {};
  std::filesystem::remove(part, fault);
  if (run.status == kNotInPath) {
    return fmt::format(
        "{}: found no program 'xacro' in PATH, which expands it; install it by 'pip install "
        "xacro', "
        "or source the setup.bash of ROS 2, whose package ros-DISTRO-xacro has it",
        xacro.string());
  }
  if (run.status == kOutOfTime)
    return fmt::format("{}: xacro did not end within {} s", xacro.string(), kProgramSeconds);
  if (run.status == 0) return fmt::format("{}: xacro wrote no file", xacro.string());
  return fmt::format("{}: xacro ended with status {}: {}", xacro.string(), run.status, run.said);
}

}  // namespace clearance
