// The representations of bytes that are read. Oracle: an encoder by the rules of DDSI-RTPS 2.3
// (10.2) and DDS-XTypes 1.3 (7.4), for the lists of fields that are in the order of the IDL.
#include "monitor/wire/cdr.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

#include "monitor/wire/slow_message_fields.hpp"
#include "tests/monitor/wire/wire_samples.hpp"

namespace clearance::test {
namespace {

struct CdrRepresentation {
  std::uint8_t id;
  bool is_big_endian;
  std::size_t alignment;  // of numbers of 8 bytes
};
constexpr CdrRepresentation kRepresentations[] = {
    {0, true, 8}, {1, false, 8}, {6, true, 4}, {7, false, 4}};

// Appends fields in the order in which it visits them.
class RuleEncoder {
 public:
  explicit RuleEncoder(const CdrRepresentation& as) : as_(as) {}

  template <class Value>
  void operator()(const Field&, const Value& value) {
    add(value);
  }
  // Padded to 4 bytes, with the number of bytes of padding in the header.
  [[nodiscard]] std::vector<std::byte> bytes() const {
    const std::size_t padding = (4 - body_.size() % 4) % 4;
    std::vector<std::byte> all = {std::byte{0}, std::byte{as_.id}, std::byte{0},
                                  static_cast<std::byte>(padding)};
    all.insert(all.end(), body_.begin(), body_.end());
    all.resize(all.size() + padding);
    return all;
  }

 private:
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void add(Number number) {
    const std::size_t alignment = std::min(sizeof number, as_.alignment);
    body_.resize((body_.size() + alignment - 1) / alignment * alignment + sizeof number);
    put(number, body_.size() - sizeof number);
  }
  template <class Number>
  void put(Number number, std::size_t at) {
    std::memcpy(body_.data() + at, &number, sizeof number);
    if (as_.is_big_endian) std::reverse(body_.begin() + at, body_.begin() + at + sizeof number);
  }
  void add_text(std::string_view text) {
    add(static_cast<std::uint32_t>(text.size() + 1));
    for (const char c : text) add(c);
    add('\0');
  }
  template <std::size_t N>
  void add(const char (&text)[N]) {
    add_text(text);
  }
  void add(char* const& text) { add_text(text == nullptr ? "" : text); }
  template <HasFields Value>
  void add(const Value& value) {
    for_each_field(*this, value);
  }
  // In XCDR2, the size of what follows stands before lists of texts and structs.
  template <MessageSequence Sequence>
  void add(const Sequence& list) {
    using Element = std::remove_pointer_t<decltype(list._buffer)>;
    const bool has_size = as_.alignment == 4 && !std::is_arithmetic_v<Element>;
    if (has_size) add(std::uint32_t{0});
    const std::size_t begin = body_.size();
    add(list._length);
    for (std::uint32_t i = 0; i < list._length; ++i) add(list._buffer[i]);
    if (has_size) put(static_cast<std::uint32_t>(body_.size() - begin), begin - 4);
  }

  CdrRepresentation as_;
  std::vector<std::byte> body_;
};

template <class Message>
std::vector<std::byte> by_rules(const Message& message, const CdrRepresentation& as) {
  RuleEncoder encoder(as);
  for_each_field(encoder, message);
  return encoder.bytes();
}

template <class T>
class Representations : public testing::Test {};
using InOrderOfTheIdl = testing::Types<clearance_msg_Health, clearance_msg_Catalogue>;
TYPED_TEST_SUITE(Representations, InOrderOfTheIdl);

TYPED_TEST(Representations, OfBothVersionsAndByteOrdersAreReadAlike) {
  std::mt19937_64 random(11);
  CdrDecoder decoder;
  for (int i = 0; i < 20; ++i) {
    Sample<TypeParam> sample, came;
    fill(random, sample);
    CdrEncoder encoder;
    const auto ours = encoder.encode(*sample);
    const std::vector<std::byte> expected(ours.begin(), ours.end());
    EXPECT_EQ(by_rules(*sample, kRepresentations[1]), expected) << "as we write";
    for (const CdrRepresentation& each : kRepresentations) {
      // Bytes of Cyclone's reader are checked, and are not swapped.
      for (const CdrBytes origin : {CdrBytes::kUnchecked, CdrBytes::kOfReader}) {
        ASSERT_TRUE(decoder.decode(by_rules(*sample, each), came, origin)) << int{each.id};
        const auto again = encoder.encode(*came);
        EXPECT_TRUE(std::ranges::equal(again, expected)) << int{each.id};
      }
    }
  }
}

// Lists of parameters and delimited types, for example.
TEST(Cdr, OfAnyOtherRepresentationIsRefused) {
  std::vector<std::byte> bytes = by_rules(*Sample<clearance_msg_Health>(), kRepresentations[1]);
  Sample<clearance_msg_Health> came;
  CdrDecoder decoder;
  for (int id = 0; id < 0x10000; ++id) {
    if (std::ranges::find(kRepresentations, id, &CdrRepresentation::id) !=
        std::end(kRepresentations))
      continue;
    bytes[0] = static_cast<std::byte>(id >> 8);
    bytes[1] = static_cast<std::byte>(id & 0xff);
    for (const CdrBytes origin : {CdrBytes::kUnchecked, CdrBytes::kOfReader})
      ASSERT_FALSE(decoder.decode(bytes, came, origin)) << id;
  }
}

TEST(Cdr, MayHaveUpToThreeBytesBehindItsLastField) {
  const Sample<clearance_msg_ZoneState> sample;
  CdrEncoder encoder;
  const auto ours = encoder.encode(*sample);
  std::vector<std::byte> bytes(ours.begin(), ours.end());
  bytes.resize(bytes.size() - std::to_integer<std::size_t>(bytes[3]));
  Sample<clearance_msg_ZoneState> came;
  CdrDecoder decoder;
  for (int behind = 0; behind < 8; ++behind, bytes.push_back({}))
    EXPECT_EQ(decoder.decode(bytes, came), behind <= 3) << behind;
}

// Lengths have 32 bits. The memory is never touched beyond its first bytes.
TEST(Cdr, OfMoreThanALengthCanSayIsRefused) {
  constexpr std::size_t kSize = (std::size_t{1} << 32) + 4096;
  void* const memory = mmap(nullptr, kSize, PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  const std::span bytes(static_cast<std::byte*>(memory), kSize);
  bytes[1] = std::byte{1};
  Sample<clearance_msg_ZoneState> came;
  for (const CdrBytes origin : {CdrBytes::kUnchecked, CdrBytes::kOfReader})
    EXPECT_FALSE(CdrDecoder().decode(bytes, came, origin));
  munmap(memory, kSize);
}

}  // namespace
}  // namespace clearance::test
