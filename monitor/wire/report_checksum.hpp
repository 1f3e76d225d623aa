// Checksums by which the reports of two daemons are compared, and the CRC by which a client finds
// that a message is not as its daemon wrote it.
#pragma once

#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "monitor/inputs/checksum.hpp"
#include "monitor/wire/crc64.hpp"
#include "monitor/wire/report_check.hpp"
#include "monitor/wire/report_values.hpp"
#include "monitor/wire/slow_message_fields.hpp"

namespace clearance {

// For the lists of fields: the same for a report and for its message.
template <class Sum>
class AddToSum {
 public:
  explicit AddToSum(Sum& sum) : sum_(sum) {}

  template <class Value>
  void operator()(const Field&, const Value& value) const noexcept {
    add(value);
  }

 private:
  template <class Value>
  requires(std::is_arithmetic_v<Value> ||
           std::is_enum_v<Value>) void add(const Value& value) const noexcept {
    sum_.add(value);
  }
  // A text counts up to its first zero, and the zero counts. A null pointer is an empty text.
  template <std::size_t N>
  void add(const char (&text)[N]) const noexcept {
    for (std::size_t i = 0; i < N; ++i) {
      sum_.add(text[i]);
      if (text[i] == 0) return;
    }
  }
  void add(char* const& text) const noexcept {
    for (const char* at = text == nullptr ? "" : text;; ++at) {
      sum_.add(*at);
      if (*at == 0) return;
    }
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

  Sum& sum_;
};
using AddToChecksum = AddToSum<Checksum>;

// The checksum of everything in Distances that the tick determines, from a report or its message.
template <class Report>
[[nodiscard]] std::uint64_t checksum_of(const Report& report) noexcept {
  Checksum sum;
  DistanceFields::for_each(AddToChecksum(sum), report);
  return sum.value();
}

// The checksum that partners compare beside state_checksum: of the report, of the zones that the
// message says are active, and of its period. A message that carries only what changed depends on
// those before it: then state_checksum stands for the whole report, too.
[[nodiscard]] inline std::uint64_t compared_checksum(
    const clearance_msg_Distances& message) noexcept {
  Checksum sum;
  sum.add(message.changes_since == 0 ? message.checksum : std::uint64_t{0});
  AddToChecksum{sum}(Field{}, message.active_zones);
  sum.add(message.period_ns);
  return sum.value();
}

inline void add_text(const char* text, Checksum& sum) noexcept {
  for (; *text != '\0'; ++text) sum.add(static_cast<std::uint64_t>(*text));
  sum.add(std::uint64_t{0});
}

// A checksum of the inputs on which a message rests: its sources, with numbers and contents.
[[nodiscard]] inline std::uint64_t inputs_checksum_of(
    const clearance_msg_Distances& message) noexcept {
  Checksum sum;
  sum.add(message.sources._length);
  for (std::uint32_t i = 0; i < message.sources._length; ++i) {
    add_text(message.sources._buffer[i].source, sum);
    sum.add(message.sources._buffer[i].sequence_number);
  }
  AddToChecksum{sum}(Field{}, message.source_contents);
  return sum.value();
}

// A number of what a message of a tick is written for.
[[nodiscard]] inline std::uint64_t report_address(std::uint32_t domain, std::string_view partition,
                                                  std::string_view topic) noexcept {
  Crc64 crc;
  crc.add(domain);
  for (const std::string_view text : {partition, topic}) {
    for (const char c : text) crc.add(c);
    crc.add('\0');
  }
  return crc.value();
}

// The CRC of all fields of a message but the one that states it.
template <class Message>
[[nodiscard]] std::uint64_t crc_of(Message message) noexcept {
  message.delivery_checksum = 0;
  Crc64 crc;
  for_each_field(AddToSum<Crc64>(crc), std::as_const(message));
  return crc.value();
}

// States the address and the CRC in a message that is complete otherwise, and in one of a partner
// the checksum that partners compare.
template <class Message>
void seal(Message& message, std::uint64_t address) noexcept {
  if constexpr (requires { message.lineage; }) {
    if (*message.partner != '\0') message.checksum = checksum_of(message);
  }
  message.address = address;
  message.delivery_checksum = crc_of(message);
}

// No bit of the message has changed since its daemon sealed it.
template <class Message>
[[nodiscard]] bool has_its_crc(const Message& message) noexcept {
  return crc_of(message) == message.delivery_checksum;
}

// Returns kGood for a message as a daemon wrote it for this address, and otherwise the error.
template <class Message>
[[nodiscard]] ReportError delivery_error(const Message& message, std::uint64_t address) noexcept {
  using enum ReportError;
  if (!has_its_crc(message)) return kCorrupt;
  if (message.address != address) return kOtherAddress;
  return has_values_of_a_daemon(message) ? kGood : kCorrupt;
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
