// Files go by their absolute paths, and are compressed where that makes them smaller.
#include "monitor/recording/attached_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>
#include <variant>

#include "config/scene/revision.hpp"
#include "config/text/file_bytes.hpp"
#include "monitor/files/compression.hpp"
#include "monitor/recording/recorded_cell.hpp"

namespace clearance {
namespace {

AttachedFiles without(std::string why) {
  AttachedFiles none;
  none.missing = std::move(why);
  return none;
}

AttachedFile kept(const std::string& name, const std::string& text, std::uint64_t revision,
                  bool compress) {
  AttachedFile one{name, "application/octet-stream", {}, revision};
  const auto bytes = std::as_bytes(std::span(text));
  if (compress) compress_zstd(bytes, one.bytes);
  if (one.bytes.empty()) {
    one.bytes.assign(bytes.begin(), bytes.end());
  } else {
    one.media_type = kZstdMediaType;
  }
  return one;
}

}  // namespace

AttachedFiles attached_files(const Cell& cell, const RecordingOptions& options,
                             const AttachedFiles& before) {
  if (cell.files.empty() || options.attach_bytes == 0) return {};
  AttachedFiles all{.files = {}, .cell_file = cell.file.string(), .missing = {}};
  std::uint64_t total = 0;
  for (const std::filesystem::path& file : cell.files) {
    const auto read = read_bytes(file.string());
    if (const auto* fault = std::get_if<FileFault>(&read)) return without(fault->reason);
    const std::string& text = std::get<std::string>(read);
    Revision revision;
    revision.add(text);
    const auto same = std::ranges::find_if(before.files, [&](const AttachedFile& one) {
      return one.name == file.string() && one.revision == revision.value();
    });
    all.files.push_back(same == before.files.end()
                            ? kept(file.string(), text, revision.value(), options.compress)
                            : *same);
    total += all.files.back().bytes.size();
    if (total > options.attach_bytes) {
      return without(fmt::format("they are more than {:.1f} MB",
                                 1e-6 * static_cast<double>(options.attach_bytes)));
    }
  }
  return all;
}

}  // namespace clearance
