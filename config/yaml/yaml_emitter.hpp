// The formats that the writers of cell files share, for yaml-cpp's emitter.
#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <string>

#include "core/vec.hpp"

namespace clearance {

// Returns the shortest decimal that reads back as the same double; zero has no minus sign.
[[nodiscard]] inline std::string shortest(double value) {
  return fmt::format("{}", value == 0.0 ? 0.0 : value);
}

// Returns the number with this many decimals.
[[nodiscard]] inline std::string decimals(double value, int count) {
  return fmt::format("{:.{}f}", value, count);
}

// Emits [ITEM, ITEM, ...] on one line. The emitter has to accept each item: a string, or a node.
template <class... Items>
void emit_list(YAML::Emitter& out, const Items&... items) {
  out << YAML::Flow << YAML::BeginSeq;
  ((out << items), ...);
  out << YAML::EndSeq;
}

// Emits a vector in shortest decimals.
inline void emit(YAML::Emitter& out, const Vec3& v) {
  emit_list(out, shortest(v.x()), shortest(v.y()), shortest(v.z()));
}

// Emits text in double quotes, which no name or reason can break.
inline void emit_text(YAML::Emitter& out, const std::string& text) {
  out << YAML::DoubleQuoted << text;
}

}  // namespace clearance
