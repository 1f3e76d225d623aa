// What the writers of cell files share on top of yaml-cpp's emitter.
#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <string>

#include "core/vec.hpp"

namespace clearance {

// The shortest decimal that reads back as the same double; no minus sign on zero.
[[nodiscard]] inline std::string shortest(double value) {
  return fmt::format("{}", value == 0.0 ? 0.0 : value);
}

// In this many decimals.
[[nodiscard]] inline std::string decimals(double value, int count) {
  return fmt::format("{:.{}f}", value, count);
}

// [ITEM, ITEM, ...] on one line. Items are what the emitter takes: strings, or nodes.
template <class... Items>
void emit_list(YAML::Emitter& out, const Items&... items) {
  out << YAML::Flow << YAML::BeginSeq;
  ((out << items), ...);
  out << YAML::EndSeq;
}

// A vector in shortest decimals.
inline void emit(YAML::Emitter& out, const Vec3& v) {
  emit_list(out, shortest(v.x()), shortest(v.y()), shortest(v.z()));
}

// Text in double quotes, which no name or reason can break.
inline void emit_text(YAML::Emitter& out, const std::string& text) {
  out << YAML::DoubleQuoted << text;
}

}  // namespace clearance
