// The result of a check as JUnit's XML, which CI systems show.
#pragma once

#include <filesystem>
#include <string>

#include "monitor/replay/offline_replay.hpp"

namespace clearance {

// A case of the class `cell` for the recording, `name`, and one for each expectation of it, with
// the least distance. Comparisons are of the recording's own case. If the replay could not be run,
// or not to its end, this is an error of that case, which is then the only one. Properties count
// ticks, and those in which an expectation was not judged. Returns why the file cannot be written,
// or nothing.
[[nodiscard]] std::string write_junit(const std::filesystem::path& file, const std::string& cell,
                                      const std::string& name, const OfflineReplay& replay,
                                      double took_s);

}  // namespace clearance
