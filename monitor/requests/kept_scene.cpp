#include "monitor/requests/kept_scene.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string_view>
#include <system_error>

#include "config/text/file_bytes.hpp"
#include "monitor/requests/durable_file.hpp"

namespace clearance {
namespace {

// The first line, a comment of YAML, with the revision in 16 hexadecimal digits.
constexpr std::string_view kMark = "# clearanced --keep-scene: changed from the cell's revision ";
constexpr std::size_t kDigits = 16;

}  // namespace

std::variant<std::optional<KeptScene>, std::string> read_kept_scene(
    const std::filesystem::path& file) {
  std::error_code error;
  remove_unfinished(file.has_parent_path() ? file.parent_path() : ".", file.filename().string());
  if (!std::filesystem::exists(file, error) && !error) return std::nullopt;
  const auto read = read_bytes(file.string());
  if (const auto* fault = std::get_if<FileFault>(&read)) return fault->reason;
  const std::string_view text = std::get<std::string>(read);
  KeptScene scene;
  const std::size_t head = kMark.size() + kDigits;
  const bool has_head = text.starts_with(kMark) && text.size() > head && text[head] == '\n';
  const char* const digits = text.data() + kMark.size();
  if (!has_head ||
      std::from_chars(digits, digits + kDigits, scene.began_with, 16).ptr != digits + kDigits) {
    return fmt::format("'{}' was not written by --keep-scene, or is damaged", file.string());
  }
  scene.yaml = text.substr(head + 1);
  return scene;
}

std::string keep_scene(const std::filesystem::path& file, const KeptScene& scene) {
  return write_durably(file, fmt::format("{}{:016x}\n{}", kMark, scene.began_with, scene.yaml));
}

}  // namespace clearance
