// A figure as the registers of a row, rounded towards its safe end.
#pragma once

#include <array>
#include <cstdint>

#include "config/cell/plc_settings.hpp"

namespace clearance::plc {

struct Encoded {
  double count = 0.0;                    // what the registers say, in counts of the row's scale
  bool fits = true;                      // false: the figure is above what the type can hold
  std::array<std::uint16_t, 2> words{};  // as many as the row's type has
};

// The least count that a row can have: what it says while nothing is known.
[[nodiscard]] double safe_end(const PlcRow& row) noexcept;

// `value` is in m, a share of the full speed, or a count. The largest count that is not above it is
// encoded; the safe end if there is none, or if the value is NaN or too large for the type. `order`
// is an index into kPlcOrders.
[[nodiscard]] Encoded encode(const PlcRow& row, std::uint8_t order, double value) noexcept;

}  // namespace clearance::plc
