// Whether the values of a message of a tick are ones that a daemon writes. A CRC says that they are
// as they were sent, and not by whom.
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "monitor/wire/slow_message_fields.hpp"

namespace clearance {

// A visitor of fields: no bound is NaN, no share is beyond 0 and 1, no enumeration has other
// values.
class ValuesOfADaemon {
 public:
  template <class Value>
  void operator()(const Field& field, const Value& value) noexcept {
    if constexpr (std::is_floating_point_v<Value>) {
      const bool is_share = value >= 0.0 && value <= 1.0;
      if (field.meaning == Meaning::kBound && std::isnan(value)) are_sound_ = false;
      if (field.meaning == Meaning::kShare && !is_share) are_sound_ = false;
    } else if constexpr (std::is_integral_v<Value>) {
      if (static_cast<std::uint64_t>(value) > last_value(field.meaning)) are_sound_ = false;
    } else if constexpr (MessageSequence<Value>) {
      using Element = std::remove_reference_t<decltype(*value._buffer)>;
      if constexpr (HasFields<Element>) {
        for (std::uint32_t i = 0; i < value._length; ++i) for_each_field(*this, value._buffer[i]);
      }
    } else if constexpr (HasFields<Value>) {
      for_each_field(*this, value);
    }
  }
  [[nodiscard]] bool are_sound() const noexcept { return are_sound_; }

 private:
  bool are_sound_ = true;
};

template <class Message>
[[nodiscard]] bool has_values_of_a_daemon(const Message& message) noexcept {
  ValuesOfADaemon found;
  for_each_field(found, message);
  return found.are_sound();
}

}  // namespace clearance
