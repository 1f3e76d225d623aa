// A generated warehouse: a cell of any size to try the monitor on.
//
// Rows of racks with pallets and boxes; in the aisles between them forklifts, mobile robots and
// people, every twentieth object or so; a robot arm at the end of the first aisle. What moves is
// watched against everything, 48,000 pairs of 1,000 objects. Nothing ever touches: whoever drives
// has a stretch of an aisle to itself.
#pragma once

#include <cstdint>
#include <string>

namespace clearance {

struct WarehouseOptions {
  std::uint32_t objects = 1000;  // at least kLeastWarehouse, at most 4096
  std::uint64_t seed = 1;
};

// Room for one bay, the station with its arm, and some vehicles.
inline constexpr std::uint32_t kLeastWarehouse = 60;

// The YAML of the cell. Same options, same text.
[[nodiscard]] std::string warehouse_cell(const WarehouseOptions& options);

}  // namespace clearance
