#include "monitor/interface/invariant.hpp"

#include <cstdio>
#include <cstdlib>

namespace clearance {

void invariant_broken(const char* what, const char* file, int line) noexcept {
  std::fprintf(stderr, "%s:%d: an invariant of the tick does not hold: %s\n", file, line, what);
  std::abort();
}

}  // namespace clearance
