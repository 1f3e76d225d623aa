// Reads `plc:`, what clearance-plc tells programmable logic controllers.
#pragma once

#include <filesystem>

#include "config/cell/plc_settings.hpp"
#include "config/yaml/map_reader.hpp"

namespace clearance {

// Takes the key out of `cell`, the top level. `scene` is complete: rows name its zones and robots,
// which are not judged after other mistakes. Paths are relative to `directory`.
[[nodiscard]] PlcSettings read_plc(MapReader& cell, const std::filesystem::path& directory,
                                   const Scene& scene, Diagnostics& diagnostics);

}  // namespace clearance
