// Checksums by which the reports of two daemons are compared, and a message with what it says of
// itself.
#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "monitor/inputs/checksum.hpp"
#include "monitor/wire/message_fields.hpp"

namespace clearance {

// For the lists of fields: the same for a report and for its message. Leaves out who sent it.
class AddToChecksum {
 public:
  explicit AddToChecksum(Checksum& sum) : sum_(sum) {}

  template <class Value>
  void operator()(const Field& field, const Value& value) const noexcept {
    if (field.meaning != Meaning::kDelivery) add(value);
  }

 private:
  template <class Value>
  requires(std::is_arithmetic_v<Value> ||
           std::is_enum_v<Value>) void add(const Value& value) const noexcept {
    sum_.add(value);
  }
  void add(const Vec3& v) const noexcept { sum_.add3(v); }
  void add(const clearance_msg_Vector3& v) const noexcept {
    sum_.add(v.x);
    sum_.add(v.y);
    sum_.add(v.z);
  }
  template <HasFields Value>
  void add(const Value& value) const noexcept {
    for_each_field(*this, value);
  }
  template <class Element>
  void add(const std::vector<Element>& list) const noexcept {
    sum_.add(list.size());
    for (const Element& element : list) add(element);
  }
  template <MessageSequence Sequence>
  void add(const Sequence& list) const noexcept {
    sum_.add(static_cast<std::uint64_t>(list._length));
    for (std::uint32_t i = 0; i < list._length; ++i) add(list._buffer[i]);
  }

  Checksum& sum_;
};

// The checksum of everything in Distances that the tick determines, from a report or its message.
template <class Report>
[[nodiscard]] std::uint64_t checksum_of(const Report& report) noexcept {
  Checksum sum;
  DistanceFields::for_each(AddToChecksum(sum), report);
  return sum.value();
}

// The checksum that partners compare beside state_checksum: of the report, and of the zones that
// the message says are active. A message that carries only what changed depends on those before it:
// then state_checksum stands for the whole report, too.
[[nodiscard]] inline std::uint64_t compared_checksum(
    const clearance_msg_Distances& message) noexcept {
  Checksum sum;
  sum.add(message.changes_since == 0 ? message.checksum : std::uint64_t{0});
  AddToChecksum{sum}(Field{}, message.active_zones);
  return sum.value();
}

inline void add_text(const char* text, Checksum& sum) noexcept {
  for (; *text != '\0'; ++text) sum.add(static_cast<std::uint64_t>(*text));
  sum.add(std::uint64_t{0});
}

// A checksum of the inputs on which a message rests: its sources with their numbers.
[[nodiscard]] inline std::uint64_t inputs_checksum_of(
    const clearance_msg_Distances& message) noexcept {
  Checksum sum;
  sum.add(message.sources._length);
  for (std::uint32_t i = 0; i < message.sources._length; ++i) {
    add_text(message.sources._buffer[i].source, sum);
    sum.add(message.sources._buffer[i].sequence_number);
  }
  return sum.value();
}

// Covers the fields of a message that checksum_of() leaves out: who sent it, when, and on which
// inputs, and the zones, whose whole states are in state_checksum.
[[nodiscard]] inline std::uint64_t delivery_checksum_of(
    const clearance_msg_Distances& message) noexcept {
  Checksum sum;
  sum.add(message.daemon);
  sum.add(message.publish_ns);
  add_text(message.partner, sum);
  sum.add(message.lineage);
  sum.add(message.checksum);
  sum.add(message.state_checksum);
  sum.add(message.changes_since);
  sum.add(inputs_checksum_of(message));
  AddToChecksum{sum}(Field{}, message.active_zones);
  return sum.value();
}

// States both checksums in a message that is complete otherwise.
inline void seal(clearance_msg_Distances& message) noexcept {
  message.checksum = checksum_of(message);
  message.delivery_checksum = delivery_checksum_of(message);
}

// No bit of the message has flipped since its daemon stated them.
[[nodiscard]] inline bool has_its_checksums(const clearance_msg_Distances& message) noexcept {
  const std::uint64_t delivery = message.delivery_checksum;
  return checksum_of(message) == message.checksum &&
         (delivery == 0 || delivery == delivery_checksum_of(message));
}

// The checksum of the rest of a report, and of the state of its tick. The counts of refused samples
// are left out: a daemon that has joined counts from another start.
[[nodiscard]] inline std::uint64_t checksum_of_rest(const Report& report,
                                                    std::uint64_t state) noexcept {
  Checksum sum;
  const AddToChecksum add(sum);
  add(Field{}, report.zones);
  add(Field{}, report.separated_pairs);
  add(Field{}, report.separated_zones);
  add(Field{}, report.stops);
  add(Field{}, report.gradients);
  sum.add(state);
  return sum.value();
}

}  // namespace clearance
