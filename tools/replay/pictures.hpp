// Pictures of a run by clearance-view, which lies in the same folder as this program.
#pragma once

#include <string>
#include <vector>

#include "tools/replay/arguments.hpp"
#include "tools/replay/report_page.hpp"

namespace clearance {

// Writes the pictures that the moments name. Returns an empty text, or why there are none.
[[nodiscard]] std::string take_pictures(const CheckArguments& arguments, const std::string& cell,
                                        const std::vector<PicturedMoment>& moments);

}  // namespace clearance
