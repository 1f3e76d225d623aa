// What the subcommands share that write cells and propose pairs. Each tells why it fails on stderr.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/scene/sampled_contacts.hpp"

namespace clearance {

inline constexpr const char* kProgram = "clearance-scene";

// Returns the exit code.
[[nodiscard]] int write_text(const std::string& text, const std::filesystem::path& output);

// Returns the exit code. A cell that was written is read back, so that its mistakes show at once.
[[nodiscard]] int write_cell(const std::string& yaml, const std::string& output);

[[nodiscard]] std::vector<SampledPair> sample_with_progress(const Scene& scene,
                                                            SamplingOptions options);

}  // namespace clearance
