// Files that a program writes. It destroys no input, overwrites nothing unasked, and leaves no
// unfinished file that looks finished. Every refusal goes to stderr as "PROGRAM: text".
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string_view>

namespace clearance {

// Returns false and says so when `output` is also an input, which writing would destroy.
[[nodiscard]] bool output_is_not_an_input(const char* program, const std::filesystem::path& output,
                                          std::initializer_list<std::filesystem::path> inputs);

// Returns false and says so when the file exists without `force`, or when its folder does not
// exist. An empty name is no file.
[[nodiscard]] bool can_create(const char* program, const std::filesystem::path& file, bool force);

// Returns a name to write to, for a program that must overwrite nothing and still start. This is
// the file itself. If it exists without `force`, it is the first free one of NAME-2.EXT, NAME-3.EXT
// ... Returns nothing and says so when the folder does not exist or the file is not a regular one.
[[nodiscard]] std::optional<std::filesystem::path> free_name(const char* program,
                                                             const std::filesystem::path& file,
                                                             bool force);

// Writes the text into the file, in place of what was there. Returns false and says so when it
// cannot be written.
[[nodiscard]] bool write_file(const char* program, const std::filesystem::path& file,
                              std::string_view text);

// Removes an unfinished file, if it is a regular one, and says so.
void remove_unfinished(const char* program, const std::filesystem::path& file);

}  // namespace clearance
