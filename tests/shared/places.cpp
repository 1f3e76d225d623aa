#include "tests/shared/places.hpp"

namespace clearance::test::places {

std::string sources() { return CLEARANCE_SOURCE; }
std::string programs() { return CLEARANCE_BIN; }
std::string core_library() { return CLEARANCE_CORE; }
std::string mcap_js() { return CLEARANCE_MCAP_JS; }
std::string view_js() { return CLEARANCE_VIEW_JS; }
std::string view_pictures() { return CLEARANCE_VIEW_PICTURES; }
std::string hanging_disk() { return CLEARANCE_HANGING_DISK; }
std::string stepped_clock() { return CLEARANCE_STEPPED_CLOCK; }
std::string failing_memory() { return CLEARANCE_FAILING_MEMORY; }

}  // namespace clearance::test::places
