// What is wrong with a refused value, for people.
#pragma once

#include <string>

#include "monitor/inputs/refused_value.hpp"

namespace clearance {

// By its cause: "(1, 2, 3) m at 4 m/s", "stamped 3.2 s ahead"; empty if none was refused.
[[nodiscard]] std::string text_of(const RefusedValue& refused);

}  // namespace clearance
