#include "monitor/recording/recorded_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "monitor/files/temporary_folder.hpp"
#include "monitor/mcap/attachments.hpp"
#include "monitor/mcap/compression.hpp"

namespace clearance {
namespace {

// No compressed file may become larger.
constexpr std::size_t kLargestFile = std::size_t{1} << 28;

// The recording determines the paths, so only those under the root are accepted.
bool stays_inside(const std::filesystem::path& name) {
  return name.is_absolute() && name.has_filename() && name == name.lexically_normal() &&
         std::none_of(name.begin(), name.end(),
                      [](const std::filesystem::path& part) { return part == ".."; });
}

bool put_under(const std::filesystem::path& root, McapAttachment attachment) {
  if (attachment.media_type == kZstdMediaType) {
    std::vector<std::byte> bytes;
    decompress(McapCompression::kZstd, attachment.bytes, kLargestFile, bytes);
    attachment.bytes = std::move(bytes);
  }
  const auto path = root / std::filesystem::path(attachment.name).relative_path();
  std::error_code fault;
  std::filesystem::create_directories(path.parent_path(), fault);
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(attachment.bytes.data()),
            static_cast<std::streamsize>(attachment.bytes.size()));
  out.close();
  return out.good();
}

std::string leads_out(const std::string& name) {
  return fmt::format("'{}' leads out of the recording", name);
}

CellResult failed(const std::filesystem::path& recording, const std::string& why) {
  return std::vector<CellError>{
      {fmt::format("{}: the files of its cell cannot be used: {}; expected --cell instead",
                   recording.string(), why)}};
}

}  // namespace

std::optional<CellResult> recorded_cell(const std::filesystem::path& recording,
                                        const RecordingOutline& outline, CellOptions options) {
  const char* const yaml = outline.catalogue ? (*outline.catalogue)->cell_yaml : nullptr;
  if (yaml == nullptr || *yaml == '\0') return std::nullopt;
  if (outline.cell_file.empty()) return parse_cell(yaml, recording, options);
  if (!stays_inside(outline.cell_file)) return failed(recording, leads_out(outline.cell_file));
  McapAttachments attachments = read_first_attachments(recording);
  if (!attachments.error.empty()) return failed(recording, attachments.error);
  const TemporaryFolder folder;
  if (!folder.error().empty()) return failed(recording, folder.error());
  for (McapAttachment& attachment : attachments.found) {
    const std::string name = attachment.name;
    if (!stays_inside(name)) return failed(recording, leads_out(name));
    if (!put_under(folder.path(), std::move(attachment)))
      return failed(recording, fmt::format("'{}' cannot be written", name));
  }
  const std::filesystem::path cell(outline.cell_file);
  options.root = folder.path();
  return parse_cell(yaml, folder.path() / cell.relative_path(), options);
}

}  // namespace clearance
