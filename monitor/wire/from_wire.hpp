// Copies the values of messages into a report. It is the inverse of ToWire, over the same lists of
// fields.
#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "monitor/wire/message_fields.hpp"

namespace clearance {

// For for_each_field(FromWire{}, message, report). It allocates if a vector has to grow. A number
// without an enumerator is kept, and name() accepts it.
struct FromWire {
  template <class From, class To>
  void operator()(const Field&, const From& from, To& to) const {
    put(from, to);
  }

 private:
  template <class T>
  static void put(const T& from, T& to) noexcept {
    to = from;
  }
  template <class Enumeration>
  requires std::is_enum_v<Enumeration>
  static void put(const std::uint8_t& from, Enumeration& to) noexcept {
    to = static_cast<Enumeration>(from);
  }
  static void put(const clearance_msg_Vector3& from, Vec3& to) noexcept {
    to = {from.x, from.y, from.z};
  }
  template <HasFields From, HasFields To>
  static void put(const From& from, To& to) {
    for_each_field(FromWire{}, from, to);
  }
  template <MessageSequence From, class To>
  static void put(const From& from, std::vector<To>& to) {
    to.resize(from._length);
    for (std::uint32_t i = 0; i < from._length; ++i) put(from._buffer[i], to[i]);
  }
};

}  // namespace clearance
