#include "monitor/recording/recorded_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "monitor/files/attachments.hpp"
#include "monitor/files/compression.hpp"
#include "monitor/files/temporary_folder.hpp"
#include "monitor/recording/writer.hpp"

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

// `before`: as of read_attachments().
CellResult read_recorded(const std::filesystem::path& recording, const std::string& yaml,
                         const std::string& cell_file, std::optional<std::uint64_t> before,
                         CellOptions options) {
  if (cell_file.empty()) return parse_cell(yaml, recording, options);
  if (!stays_inside(cell_file)) return failed(recording, leads_out(cell_file));
  McapAttachments attachments = read_attachments(recording, before);
  if (!attachments.error.empty()) return failed(recording, attachments.error);
  const TemporaryFolder folder;
  if (!folder.error().empty()) return failed(recording, folder.error());
  for (McapAttachment& attachment : attachments.found) {
    const std::string name = attachment.name;
    if (!stays_inside(name)) return failed(recording, leads_out(name));
    if (!put_under(folder.path(), std::move(attachment)))
      return failed(recording, fmt::format("'{}' cannot be written", name));
  }
  options.root = folder.path();
  return parse_cell(yaml, folder.path() / std::filesystem::path(cell_file).relative_path(),
                    options);
}

// The number of a key; 0: there is none.

}  // namespace

std::optional<CellResult> recorded_cell(const std::filesystem::path& recording,
                                        const RecordingOutline& outline, CellOptions options) {
  const char* const yaml = outline.catalogue ? (*outline.catalogue)->cell_yaml : nullptr;
  if (yaml == nullptr || *yaml == '\0') return std::nullopt;
  options.share = (*outline.catalogue)->share;
  return read_recorded(recording, yaml, outline.cell_file, std::nullopt, std::move(options));
}

std::vector<DescribedScene> described_scenes(const std::vector<std::filesystem::path>& files) {
  std::vector<DescribedScene> all;
  std::uint64_t joined = 0;
  for (const std::filesystem::path& file : files) {
    for (const McapMetadata& found : read_metadata(file)) {
      if (found.name == kJoinedMetadata) joined = number_of(found.values, "number");
      if (found.name != kRecordingMetadata) continue;
      const auto text = [&found](const std::string& key) {
        const auto value = found.values.find(key);
        return value == found.values.end() ? std::string() : value->second;
      };
      DescribedScene scene{.daemon = number_of(found.values, "daemon"),
                           .revision = number_of(found.values, "scene_revision"),
                           .since = {.began_after = number_of(found.values, "began_after"),
                                     .from = number_of(found.values, "in_force_from")},
                           .yaml = text("cell"),
                           .cell_file = text("cell_file"),
                           .share = text("share"),
                           .recording = file,
                           .place = found.offset,
                           .joined = joined};
      std::erase_if(all, [&scene](const DescribedScene& before) {
        const bool is_same = before.daemon == scene.daemon && before.revision == scene.revision &&
                             before.since == scene.since;
        if (is_same) scene.joined = before.joined;
        return is_same;
      });
      all.push_back(std::move(scene));
    }
  }
  return all;
}

std::vector<FormerScene> former_scenes(const std::filesystem::path& file) {
  std::vector<FormerScene> all;
  for (const McapMetadata& found : read_metadata(file)) {
    const auto objects = found.values.find("objects");
    if (found.name != kFormerMetadata || objects == found.values.end()) continue;
    FormerScene& scene = all.emplace_back();
    scene.revision = number_of(found.values, "scene_revision");
    std::istringstream names(objects->second);
    for (std::string name; std::getline(names, name, ',');) scene.objects.push_back(name);
  }
  return all;
}

CellResult cell_of(const DescribedScene& described, CellOptions options) {
  options.share = described.share;
  return read_recorded(described.recording, described.yaml, described.cell_file, described.place,
                       std::move(options));
}

}  // namespace clearance
