// The distance queries of the shipped cells along their simulated motion.
#pragma once

#include <filesystem>

namespace clearance::bench {

// One set of benchmarks a cell file in `folder`, in the order of their names.
void register_cells(const std::filesystem::path& folder);

}  // namespace clearance::bench
