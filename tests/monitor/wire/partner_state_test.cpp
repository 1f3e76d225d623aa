#include "monitor/wire/partner_state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>

namespace clearance {
namespace {

constexpr const char* kSentBuild = "1.2.3";
constexpr std::array<std::byte, 11> kStateBytes = {std::byte{1}, std::byte{0}, std::byte{255}};
constexpr PartnerStateView kSentState{
    .revision = 5, .lineage = 6, .cycle = 7, .bytes = kStateBytes};

TEST(PartnerState, ComesBackAsItWasSent) {
  for (const std::size_t size : {std::size_t{0}, kStateBytes.size()}) {
    PartnerStateView state = kSentState;
    state.bytes = state.bytes.first(size);
    const Sample<clearance_msg_PartnerState> message = to_wire(state, kSentBuild);
    const auto came = from_wire(*message, kSentBuild);
    ASSERT_TRUE(came);
    EXPECT_EQ(came->revision, 5u);
    EXPECT_EQ(came->lineage, 6u);
    EXPECT_EQ(came->cycle, 7u);
    ASSERT_EQ(came->bytes.size(), size);
    EXPECT_TRUE(std::ranges::equal(came->bytes, state.bytes));
  }
}

TEST(PartnerState, OfAnotherBuildOrOfNoneIsRefused) {
  Sample<clearance_msg_PartnerState> message = to_wire(kSentState, kSentBuild);
  EXPECT_FALSE(from_wire(*message, "1.2.4"));
  EXPECT_FALSE(from_wire(*message, ""));
  dds_string_free(std::exchange(message->build, nullptr));
  EXPECT_FALSE(from_wire(*message, kSentBuild));
  EXPECT_FALSE(from_wire(*message, ""));
}

TEST(PartnerState, OfWhichAnyBitIsFlippedOrAnyByteIsMissingIsRefused) {
  Sample<clearance_msg_PartnerState> message = to_wire(kSentState, kSentBuild);
  for (std::size_t bit = 0; bit < 8 * kStateBytes.size(); ++bit) {
    std::uint8_t& byte = message->bytes._buffer[bit / 8];
    byte ^= static_cast<std::uint8_t>(1u << bit % 8);
    EXPECT_FALSE(from_wire(*message, kSentBuild)) << "bit " << bit;
    byte ^= static_cast<std::uint8_t>(1u << bit % 8);
  }
  EXPECT_TRUE(from_wire(*message, kSentBuild));
  --message->bytes._length;
  EXPECT_FALSE(from_wire(*message, kSentBuild));
}

}  // namespace
}  // namespace clearance
