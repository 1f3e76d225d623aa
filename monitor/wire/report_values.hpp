// Whether a message of a tick has a value that no daemon writes: a bound that is NaN, a lower bound
// above the upper one, a share beyond 0 and 1, a status that is none. A CRC says that values are as
// they were sent, and not by whom.
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "monitor/wire/slow_message_fields.hpp"

namespace clearance {

// Visits the fields of a message.
class ValuesOfADaemon {
 public:
  template <HasFields Value>
  void check(const Value& value) noexcept {
    if constexpr (requires { value.upper; }) {
      if (!(value.lower <= value.upper)) are_sound_ = false;
    }
    for_each_field(*this, value);
  }
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
        for (std::uint32_t i = 0; i < value._length; ++i) check(value._buffer[i]);
      }
    } else if constexpr (HasFields<Value>) {
      check(value);
    }
  }
  [[nodiscard]] bool are_sound() const noexcept { return are_sound_; }

 private:
  bool are_sound_ = true;
};

template <class Message>
[[nodiscard]] bool has_values_of_a_daemon(const Message& message) noexcept {
  ValuesOfADaemon found;
  found.check(message);
  return found.are_sound();
}

}  // namespace clearance
