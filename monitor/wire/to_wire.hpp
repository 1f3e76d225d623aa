// A report's values as messages have them: one visitor for all lists of fields.
#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "monitor/wire/message_fields.hpp"

namespace clearance {

// For for_each_field(ToWire{}, report, message). Allocates nothing: what a sequence has no capacity
// for is left out.
struct ToWire {
  template <class From, class To>
  void operator()(const Field&, const From& from, To& to) const noexcept {
    put(from, to);
  }

 private:
  template <class T>
  static void put(const T& from, T& to) noexcept {
    to = from;
  }
  template <class Enumeration>
  requires std::is_enum_v<Enumeration>
  static void put(const Enumeration& from, std::uint8_t& to) noexcept {
    to = static_cast<std::uint8_t>(from);
  }
  static void put(const Vec3& from, clearance_msg_Vector3& to) noexcept {
    to = {from.x(), from.y(), from.z()};
  }
  template <HasFields From, HasFields To>
  static void put(const From& from, To& to) noexcept {
    for_each_field(ToWire{}, from, to);
  }
  template <class From, MessageSequence To>
  static void put(const std::vector<From>& from, To& to) noexcept {
    to._length = static_cast<std::uint32_t>(std::min<std::size_t>(from.size(), to._maximum));
    // Held here, because a store to an octet could change them as far as the compiler knows.
    const std::size_t length = to._length;
    auto* const elements = to._buffer;
    const From* const values = from.data();
    for (std::size_t i = 0; i < length; ++i) put(values[i], elements[i]);
  }
};

}  // namespace clearance
