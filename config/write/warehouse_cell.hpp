// A generated warehouse: a cell of any size to try the monitor on.
//
// It has rows of racks with pallets and boxes, and a robot arm at the end of the first aisle.
// Forklifts, mobile robots and people, about every twentieth object, move in the aisles. Every
// moving object is watched against all others: 48,000 pairs for 1,000 objects. Nothing ever
// touches, because each moving object has a stretch of an aisle to itself.
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
