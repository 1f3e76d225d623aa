// Matches messages about mistakes in files by their places and by what they quote from the files,
// whatever their wording. tests/config/cell/cell_errors_test.cpp holds the wording of each mistake.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace clearance::test {

// `text` has a line with the place, FILE:LINE:COLUMN, or FILE:LINE with any column or none, and
// each of these words after it.
MATCHER_P2(has_mistake, place, words, "a mistake at " + place) {
  std::istringstream lines(arg);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find(place + ":");
    if (at == std::string::npos) continue;
    const std::size_t end = line.find_first_not_of("0123456789", at + place.size() + 1);
    if (line.compare(at + place.size(), 2, ": ") != 0 && line.compare(end, 2, ": ") != 0) continue;
    const std::string message = line.substr(at + place.size());
    if (std::ranges::all_of(words, [&](const std::string& word) {
          return message.find(word) != std::string::npos;
        })) {
      return true;
    }
  }
  return false;
}

template <class... Words>
[[nodiscard]] auto mistake_at(const std::string& place, const Words&... words) {
  return has_mistake(place, std::vector<std::string>{words...});
}

}  // namespace clearance::test
