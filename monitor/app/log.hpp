// The log of a program: spdlog, to stderr.
#pragma once

#include <string>

namespace clearance {

// `level`: trace, debug, info, warn, error or off. `name` starts every line after the time.
void start_log(const std::string& name, const std::string& level);

}  // namespace clearance
