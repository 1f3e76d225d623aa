// printf into a string.
#pragma once

#include <cstdio>
#include <string>

namespace clearance::bench {

// At most 399 characters.
template <class... Values>
std::string print(const char* format, Values... values) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

}  // namespace clearance::bench
