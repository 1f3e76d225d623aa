#include "monitor/requests/durable_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>

#include "config/text/file_bytes.hpp"

namespace clearance {
namespace {

// The name of a file is kept with its folder.
bool sync_folder(const std::filesystem::path& folder) {
  const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) return false;
  const bool done = ::fsync(handle) == 0;
  ::close(handle);
  return done;
}

}  // namespace

void remove_unfinished(const std::filesystem::path& folder, std::string_view name) {
  constexpr std::string_view kEnd = ".new";
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), last; !error && at != last;
       at.increment(error)) {
    const std::string found = at->path().filename().string();
    if (!found.ends_with(kEnd)) continue;
    const std::string_view stem = std::string_view(found).substr(0, found.size() - kEnd.size());
    const std::size_t dot = stem.rfind('.');
    if (dot == stem.npos || (!name.empty() && stem.substr(0, dot) != name)) continue;
    pid_t writer = 0;
    const char* const to = stem.data() + stem.size();
    if (std::from_chars(stem.data() + dot + 1, to, writer).ptr != to || writer <= 0) continue;
    if (::kill(writer, 0) != 0 && errno == ESRCH) ::unlink(at->path().c_str());
  }
}

std::string write_durably(const std::filesystem::path& file, std::string_view bytes) {
  const std::string beside = fmt::format("{}.{}.new", file.string(), ::getpid());
  constexpr int kMode = 0644;
  const int handle = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kMode);
  bool done = handle >= 0 && write_bytes(handle, bytes) && ::fsync(handle) == 0;
  int error = errno;
  if (handle >= 0 && ::close(handle) != 0 && done) {
    error = errno;
    done = false;
  }
  if (done && ::rename(beside.c_str(), file.c_str()) != 0) {
    error = errno;
    done = false;
  }
  if (!done) {
    if (handle >= 0) ::unlink(beside.c_str());
    return fmt::format("'{}' cannot be written: {}", file.string(), std::strerror(error));
  }
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!sync_folder(folder)) {
    return fmt::format("the folder '{}' cannot be kept: {}", folder.string(), std::strerror(errno));
  }
  return {};
}

}  // namespace clearance
