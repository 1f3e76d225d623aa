// The state of an allowed contact, as text for all programs.
#pragma once

#include <string>

#include "config/scene/contact.hpp"
#include "monitor/interface/report.hpp"

namespace clearance {

// Returns, for example, "contact 'lift' allowed by planner: 1.2 of 2.0 mm deep, since cycle 17,
// until the distance is 10.0 mm". A contact that is not as allowed says so.
[[nodiscard]] std::string contact_text(const AllowedContact& contact, const ContactReport& state);

// Returns when the allowance ends, for example "until the distance is 10.0 mm or cycle 900".
[[nodiscard]] std::string end_text(const ContactEnd& end);

}  // namespace clearance
