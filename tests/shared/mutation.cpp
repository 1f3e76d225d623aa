#include "tests/shared/mutation.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>

namespace clearance::test {
namespace {

// A number from 0 to `most`.
std::size_t any(std::size_t most, std::mt19937& random) {
  return std::uniform_int_distribution<std::size_t>(0, most)(random);
}

void edit(std::string& text, std::mt19937& random) {
  constexpr std::string_view kSpice = "{}[]:,-#&*!|>'\"%@`\n\t 019.eE~xn?";
  const std::size_t at = any(text.size() - 1, random);
  const std::size_t length = std::min(1 + any(12, random), text.size() - at);
  switch (any(4, random)) {
    case 0:
      text.erase(at, length);
      break;
    case 1:
      text.insert(at, 1, kSpice[any(kSpice.size() - 1, random)]);
      break;
    case 2:
      text[at] = kSpice[any(kSpice.size() - 1, random)];
      break;
    case 3:
      text.insert(any(text.size() - 1, random), text.substr(at, length));
      break;
    default:
      text[at] = static_cast<char>(any(255, random));
  }
  if (text.empty()) text = "x";
}

// Replaces the next run of digits after a random position by another number.
void replace_number(std::string& text, std::mt19937& random) {
  constexpr std::array<std::string_view, 14> kNumbers = {
      "0",     "-1",         "1",    "9",     "13",  "4096",       "65536",
      "99999", "2147483647", "1e30", "-1e38", "nan", "4294967295", "18446744073709551615"};
  const std::size_t at = text.find_first_of("0123456789", any(text.size() - 1, random));
  if (at == std::string::npos) return;
  const std::size_t end = std::min(text.find_first_not_of("0123456789", at), text.size());
  text.replace(at, end - at, kNumbers[any(kNumbers.size() - 1, random)]);
}

void replace_word(std::string& bytes, std::mt19937& random) {
  if (bytes.size() < 4) return;
  const float values[] = {1e30f, -3.6e3f, std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity()};
  const std::uint32_t words[] = {0u, 1u, 9u, 200u, 70'000u, 0x7fffffffu, 0x80000000u, 0xffffffffu};
  char* const at = bytes.data() + any(bytes.size() - 4, random);
  if (any(2, random) == 0) {
    std::memcpy(at, &values[any(3, random)], 4);
  } else {
    std::memcpy(at, &words[any(7, random)], 4);
  }
}

}  // namespace

std::string mutated(std::string text, std::mt19937& random) {
  const std::size_t edits = 1 + any(3, random);
  for (std::size_t i = 0; i < edits; ++i) edit(text, random);
  return text;
}

std::string mutated_numbers(std::string bytes, std::mt19937& random) {
  const std::size_t edits = 1 + any(2, random);
  for (std::size_t i = 0; i < edits; ++i) {
    switch (any(7, random)) {
      case 0:
        bytes.resize(1 + any(bytes.size() - 1, random));
        break;
      case 1:
      case 2:
        edit(bytes, random);
        break;
      case 3:
      case 4:
        replace_word(bytes, random);
        break;
      default:
        replace_number(bytes, random);
    }
  }
  return bytes;
}

}  // namespace clearance::test
