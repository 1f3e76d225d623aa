// The result of a check as JUnit's XML, which CI systems show.
#pragma once

#include <filesystem>
#include <string>

#include "monitor/replay/offline_replay.hpp"

namespace clearance {

// One case, `name`, of the class `cell`. It fails with the first failure of each expectation; a
// replay that could not be run, or not to its end, is an error. Its properties count ticks, and
// those in which an expectation was not judged. Returns why the file cannot be written, or nothing.
[[nodiscard]] std::string write_junit(const std::filesystem::path& file, const std::string& cell,
                                      const std::string& name, const OfflineReplay& replay,
                                      double took_s);

}  // namespace clearance
