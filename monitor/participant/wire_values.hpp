// Texts and poses of messages, for both directions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "commands.h"
#include "config/text/utf8.hpp"
#include "core/pose.hpp"
#include "monitor/wire/dds_sample.hpp"

#include <fmt/format.h>

namespace clearance {

[[nodiscard]] inline std::string not_finite(double found) {
  return fmt::format("found {}; expected a finite number", found);
}

[[nodiscard]] inline std::string_view text_of(const char* text) {
  return text == nullptr ? "" : text;
}

// Copies a text into a bounded string, cut to fit.
template <std::size_t N>
void copy_text(std::string_view text, char (&out)[N]) {
  const std::size_t length = std::min(text.size(), N - 1);
  std::memcpy(out, text.data(), length);
  std::memset(out + length, 0, N - length);
}

// Why a text cannot be taken, or nothing.
[[nodiscard]] inline std::optional<std::string> fault_of_text(std::string_view text,
                                                              std::size_t most, bool may_be_empty) {
  if (text.empty() && !may_be_empty) return "found an empty text; expected one that is not empty";
  if (text.size() > most)
    return fmt::format("found a text of {} bytes; expected at most {}", text.size(), most);
  if (end_of_utf8(text) != text.size()) {
    return fmt::format("found a text that is no UTF-8 at byte {}; expected UTF-8",
                       end_of_utf8(text));
  }
  return std::nullopt;
}

// The field and the sentence about its value, if a placement is no pose.
struct PlacementFault {
  std::string_view field;
  std::string reason;
};
[[nodiscard]] inline std::optional<PlacementFault> take_placement(
    const clearance_msg_Placement& from, Pose& to) {
  const auto& [x, y, z] = from.position;
  to.position = Vec3(x, y, z);
  if (!to.position.allFinite())
    return PlacementFault{"position", not_finite(std::isfinite(x) ? std::isfinite(y) ? z : y : x)};
  const auto& q = from.orientation;
  to.orientation = Eigen::Quaterniond(q.w, q.x, q.y, q.z);
  if (!is_unit(to.orientation)) {
    return PlacementFault{"orientation",
                          fmt::format("found a quaternion of length {:g}; expected 1 within {:g}",
                                      to.orientation.norm(), kUnitTolerance)};
  }
  return std::nullopt;
}

// Into a message, whose texts and sequences are allocated by Cyclone.
inline void put_value(const std::string& from, char*& to) { to = dds_string_dup(from.c_str()); }
inline void put_value(const std::vector<std::string>& from, dds_sequence_string& to) {
  reserve_sequence(to, from.size());
  for (const std::string& text : from) put_value(text, to._buffer[to._length++]);
}
inline void put_value(const std::vector<double>& from, dds_sequence_double& to) {
  reserve_sequence(to, from.size());
  for (const double number : from) to._buffer[to._length++] = number;
}
inline void put_value(const Pose& from, clearance_msg_Placement& to) {
  const Eigen::Quaterniond& q = from.orientation;
  to.position = {from.position.x(), from.position.y(), from.position.z()};
  to.orientation = {q.x(), q.y(), q.z(), q.w()};
}

// Fills a sequence by put(entry, entry of the message).
template <class From, class Sequence, class Put>
void put_list(const std::vector<From>& from, Sequence& to, const Put& put) {
  reserve_sequence(to, from.size());
  for (const From& entry : from) put(entry, to._buffer[to._length++]);
}

}  // namespace clearance
