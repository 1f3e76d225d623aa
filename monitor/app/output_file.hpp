// Files that a program writes: it destroys no input, overwrites nothing unasked, and leaves nothing
// behind that looks finished and is not. Every refusal goes to stderr as "PROGRAM: what".
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>

namespace clearance {

// False, after saying so, when `output` is one of the files that are read: it would be destroyed.
[[nodiscard]] bool output_is_not_an_input(const char* program, const std::filesystem::path& output,
                                          std::initializer_list<std::filesystem::path> inputs);

// False, after saying so, when the file exists and `force` is not given, or its folder does not
// exist. An empty name is no file.
[[nodiscard]] bool can_create(const char* program, const std::filesystem::path& file, bool force);

// Where to write when nothing may be overwritten and the program must start all the same: the file
// itself, or, when it exists and `force` is not given, the first of NAME-2.EXT, NAME-3.EXT ... that
// does not. Nothing, after saying so, when its folder does not exist or the file is no regular one.
[[nodiscard]] std::optional<std::filesystem::path> free_name(const char* program,
                                                             const std::filesystem::path& file,
                                                             bool force);

// Removes a file that was not written to its end, if it is a regular one, and says what became of
// it.
void remove_unfinished(const char* program, const std::filesystem::path& file);

}  // namespace clearance
