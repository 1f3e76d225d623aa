// Numbers of a report for clearance-watch, in columns of constant width; "unknown" for NaN.
#pragma once

#include <cstdint>
#include <string>

#include "clearance.h"

namespace clearance::watch {

// Nine columns, to 0.1 mm.
[[nodiscard]] std::string metres(double value);
// "(  1.000   0.250  -0.500)", m.
[[nodiscard]] std::string point(const clearance_msg_Vector3& p);
// Seven columns; contacts more than a quarter of an hour away are not shown.
[[nodiscard]] std::string contact_time(double seconds);
// Seven columns, with its sign.
[[nodiscard]] std::string speed(double metres_per_second);
// "closing +0.512 m/s  contact in    0.98 s".
[[nodiscard]] std::string approach(const clearance_msg_PairDistance& pair);
// "3.25 ms".
[[nodiscard]] std::string precise_age(std::int64_t age_ns);

}  // namespace clearance::watch
