// The distance that a test expects of some pairs.
#pragma once

#include <string>

namespace clearance {

struct ExpectedDistance {
  double metres = 0.0;
  // An object, a group, or a zone, whose pairs count; `b` is empty for a zone. Both empty: all
  // pairs.
  std::string a = {}, b = {};
};

}  // namespace clearance
