#include "monitor/files/temporary_folder.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <system_error>

namespace clearance {

TemporaryFolder::TemporaryFolder() {
  std::error_code fault;
  const std::filesystem::path above = std::filesystem::temp_directory_path(fault);
  std::string name = (above / "clearance-XXXXXX").string();
  if (!fault && ::mkdtemp(name.data()) == nullptr) fault.assign(errno, std::system_category());
  if (fault) {
    error_ = fmt::format("cannot make a folder for temporary files in {}: {}",
                         above.empty() ? "TMPDIR" : above.string(), fault.message());
  } else {
    path_ = name;
  }
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace clearance
