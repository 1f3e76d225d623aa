#include "monitor/requests/sent_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <utility>

#include "config/text/file_bytes.hpp"
#include "config/text/fnv1a.hpp"
#include "monitor/requests/durable_file.hpp"

namespace clearance {
namespace {

constexpr std::string_view kSentFileMark = "sent:";

bool is_of_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-' || c == '.';
}

// Two hashes and the length: not against an adversary, whose files are compared byte by byte.
std::string content_name(const std::string& bytes) {
  Fnv1a a, b(0x9e3779b97f4a7c15);
  a.add(bytes);
  b.add(bytes);
  return fmt::format("{:016x}{:016x}-{}", a.value(), b.value(), bytes.size());
}

}  // namespace

SentFiles::SentFiles(const std::filesystem::path& cell_file)
    : folder_(cell_file.parent_path() / "clearance.sent") {
  remove_unfinished(folder_);
}

std::variant<std::map<std::string, std::string>, std::string> SentFiles::keep(
    const std::vector<SentFile>& files) {
  written_.clear();
  std::map<std::string, std::string> paths;
  for (const SentFile& file : files) {
    const std::string name =
        content_name(file.bytes) + std::filesystem::path(file.name).extension().string();
    const std::filesystem::path path = folder_ / name;
    paths[file.name] = (folder_.filename() / name).string();
    std::error_code error;
    if (std::filesystem::exists(path, error)) {
      const auto kept = read_bytes(path.string());
      const auto* bytes = std::get_if<std::string>(&kept);
      if (bytes != nullptr && *bytes == file.bytes) continue;
      take_back();
      return fmt::format("'{}' has another content than its name says; remove it", path.string());
    }
    std::filesystem::create_directories(folder_, error);
    if (std::string reason = write_durably(path, file.bytes); !reason.empty()) {
      take_back();
      return reason;
    }
    written_.push_back(path);
  }
  return paths;
}

void SentFiles::take_back() {
  std::error_code error;
  for (const std::filesystem::path& file : written_) std::filesystem::remove(file, error);
  written_.clear();
}

// A file that was there before is not this object's to remove, unless it waits for a cell itself.
std::string SentFiles::keep_awaited(const std::vector<SentFile>& files) {
  auto kept = keep(files);
  if (auto* reason = std::get_if<std::string>(&kept)) return std::move(*reason);
  Awaited now;
  for (const SentFile& file : files) now.bytes += file.bytes.size();
  for (const auto& [name, relative] : std::get<std::map<std::string, std::string>>(kept)) {
    const std::filesystem::path path = folder_.parent_path() / relative;
    const bool is_new = std::ranges::find(written_, path) != written_.end();
    if (is_new || is_awaited(path)) now.paths.insert(path);
  }
  written_.clear();
  if (now.paths.empty()) return {};
  awaited_.push_back(std::move(now));
  std::size_t bytes = 0;
  for (const Awaited& each : awaited_) bytes += each.bytes;
  while (awaited_.size() > 1 && (awaited_.size() > kAwaited || bytes > kAwaitedBytes)) {
    bytes -= awaited_.front().bytes;
    drop_oldest_awaited();
  }
  return {};
}

bool SentFiles::is_awaited(const std::filesystem::path& file) const {
  return std::ranges::any_of(awaited_,
                             [&](const Awaited& each) { return each.paths.contains(file); });
}

void SentFiles::drop_oldest_awaited() {
  const Paths oldest = std::move(awaited_.front().paths);
  awaited_.pop_front();
  for (const std::filesystem::path& file : oldest) {
    std::error_code error;
    if (!is_awaited(file)) std::filesystem::remove(file, error);
  }
}

void SentFiles::settle(const std::vector<std::filesystem::path>& named) {
  settled_.insert(written_.begin(), written_.end());
  written_.clear();
  for (const std::filesystem::path& file : named) {
    for (Awaited& each : awaited_) {
      if (each.paths.erase(file) > 0) settled_.insert(file);
    }
  }
  Paths& now = named_.emplace_back();
  for (const std::filesystem::path& file : named) {
    if (settled_.contains(file)) now.insert(file);
  }
  if (named_.size() > kScenes) named_.pop_front();
  std::erase_if(settled_, [this](const std::filesystem::path& file) {
    if (std::ranges::any_of(named_, [&](const Paths& paths) { return paths.contains(file); }))
      return false;
    std::error_code error;
    std::filesystem::remove(file, error);
    return true;
  });
}

std::string with_paths(const std::string& yaml, const std::map<std::string, std::string>& paths) {
  std::string text;
  std::size_t at = 0;
  for (;;) {
    const std::size_t mark = yaml.find(kSentFileMark, at);
    if (mark == std::string::npos) break;
    std::size_t end = mark + kSentFileMark.size();
    while (end < yaml.size() && is_of_name(yaml[end])) ++end;
    const bool begins = mark == 0 || !is_of_name(yaml[mark - 1]);
    const auto path =
        paths.find(yaml.substr(mark + kSentFileMark.size(), end - mark - kSentFileMark.size()));
    text += yaml.substr(at, mark - at);
    text += begins && path != paths.end() ? path->second : yaml.substr(mark, end - mark);
    at = end;
  }
  return text + yaml.substr(at);
}

}  // namespace clearance
