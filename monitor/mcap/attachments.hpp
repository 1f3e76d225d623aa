// The files that stand in front of the messages of an MCAP file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

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

// Up to the first chunk, message, or end of the data, as McapWriter puts them there.
[[nodiscard]] McapAttachments read_first_attachments(const std::filesystem::path& file);

}  // namespace clearance
