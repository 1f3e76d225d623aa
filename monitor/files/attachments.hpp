// An MCAP file has more than messages: whole files, and named sets of texts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "monitor/files/format.hpp"

namespace clearance {

// Record 0x09, without its times.
struct McapAttachment {
  std::string name, media_type;
  std::vector<std::byte> bytes;
};

struct McapAttachments {
  std::vector<McapAttachment> found;
  std::string error;  // not empty: one is damaged or too large; those before it are found
};

// Returns, in file order, the attachments that stand in front of this byte of the file. Without
// one: up to the first chunk, message, or end of the data, as McapWriter puts them there.
[[nodiscard]] McapAttachments read_attachments(const std::filesystem::path& file,
                                               std::optional<std::uint64_t> before = {});

// Record 0x0c.
struct McapMetadata {
  std::uint64_t offset = 0;  // of the record in the file
  std::string name;
  McapMap values;
};

// Returns, in file order, all attachments up to the end of the data or a damage, which the reader
// of messages reports. Reads no chunk, so that a large file takes little time.
[[nodiscard]] std::vector<McapMetadata> read_metadata(const std::filesystem::path& file);

}  // namespace clearance
