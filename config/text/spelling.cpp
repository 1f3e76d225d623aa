// Compares words by the edit distance with swaps of neighbours (optimal string alignment), which
// counts a typing error as one edit.
#include "config/text/spelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace clearance {
namespace {

// Case and punctuation are the mistakes that people make most.
std::string folded(std::string_view word) {
  std::string result;
  for (const char c : word) {
    result += c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return result;
}

}  // namespace

// Keeps three rows of the usual table of optimal string alignment (Damerau, Levenshtein).
std::size_t edit_distance(std::string_view a_word, std::string_view b_word) {
  const std::string a = folded(a_word), b = folded(b_word);
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

// Only names within a third of the word's length are suggested: others are no misspellings of it.
std::string did_you_mean(std::string_view found, std::span<const std::string> known) {
  const std::string* nearest = nullptr;
  std::size_t least = std::max<std::size_t>(1, (found.size() + 1) / 3) + 1;
  for (const std::string& name : known) {
    if (const std::size_t edits = edit_distance(found, name); edits < least) {
      least = edits;
      nearest = &name;
    }
  }
  return nearest == nullptr ? "" : fmt::format("; did you mean '{}'?", *nearest);
}

}  // namespace clearance
