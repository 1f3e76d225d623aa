// Layouts that cannot be what the message says.
//
// Oracle: the test packs the numbers, and says something else of them.
#include "monitor/intake/layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

#include "monitor/intake/frame_decoders.hpp"
#include "monitor/intake/message_form.hpp"
#include "tests/monitor/intake/camera_texts.hpp"

namespace clearance::layout_test {
namespace {

using test::camera::CloudText;
using test::camera::ImageText;
using Fault = FrameFault;
using Type = RawSensorMessage::Type;

Fault fault_of(Type type, const std::vector<std::byte>& cdr) {
  Sensor sensor;
  sensor.most_points = 200;
  CdrDecoder decoder;
  return frame_decoder(type)->decode({.type = type, .cdr = cdr}, sensor, decoder)->fault;
}
Fault fault_of(const ImageText& text) { return fault_of(Type::kImage, text.cdr()); }
Fault fault_of(const CloudText& text) { return fault_of(Type::kPoints, text.cdr()); }

// Makes an image of a tilted wall, 30 x 4 pixels. `one` is the length of one depth unit, m.
template <class Number>
ImageText leaning_wall(const std::string& encoding, double one) {
  ImageText text;
  text.width = 30, text.height = 4, text.encoding = encoding;
  text.step = 30 * sizeof(Number);
  text.data.resize(4 * std::size_t{text.step});
  for (std::size_t i = 0; i < 120; ++i) {
    const auto depth = static_cast<Number>((1.0 + 0.0037 * static_cast<double>(i % 30)) / one);
    std::memcpy(text.data.data() + i * sizeof depth, &depth, sizeof depth);
  }
  return text;
}
ImageText in_millimetres() { return leaning_wall<std::uint16_t>("16UC1", 0.001); }
ImageText in_metres() { return leaning_wall<float>("32FC1", 1.0); }

std::vector<std::uint8_t> turned(std::vector<std::uint8_t> bytes, std::size_t number) {
  for (auto at = bytes.begin(); at < bytes.end(); at += static_cast<std::ptrdiff_t>(number))
    std::reverse(at, at + static_cast<std::ptrdiff_t>(number));
  return bytes;
}

TEST(Layout, OfNumbersInTheOtherByteOrderIsRefusedWhateverTheMessageSays) {
  ImageText fine = in_metres(), coarse = in_millimetres();
  EXPECT_EQ(fault_of(fine), Fault::kNoFault);
  EXPECT_EQ(fault_of(coarse), Fault::kNoFault);
  fine.data = turned(fine.data, 4);
  coarse.data = turned(coarse.data, 2);
  EXPECT_EQ(fault_of(fine), Fault::kByteOrder);
  EXPECT_EQ(fault_of(coarse), Fault::kByteOrder);
}

TEST(Layout, OfRowsWithAsMuchPaddingAsContentIsThatOfWiderNumbers) {
  ImageText wide = in_metres();
  wide.encoding = "16UC1";
  EXPECT_EQ(fault_of(wide), Fault::kLayout);
  ImageText padded = in_millimetres();
  padded.step = 96;
  padded.data.assign(96 * 4, 0);
  EXPECT_EQ(fault_of(padded), Fault::kNoFault) << "to a multiple of 32 bytes";
}

// A leading slash of a frame's name says nothing.
TEST(MessageForm, HasOneDigestForANameOfAFrameAndNoneForNoName) {
  EXPECT_EQ(digest_of_frame("/eye"), digest_of_frame("eye"));
  EXPECT_NE(digest_of_frame("eye"), digest_of_frame("nose"));
  for (const char* none : {"", "/"}) EXPECT_EQ(digest_of_frame(none), 0u);
}

TEST(Layout, OfPointsWhoseNumbersShareBytesIsRefused) {
  const auto with = [&](const auto& change) {
    CloudText text;
    for (std::size_t i = 0; i < 25; ++i) {
      const float metres = 0.5F + 0.013F * static_cast<float>(i);
      std::memcpy(text.data.data() + 4 * i, &metres, sizeof metres);
    }
    change(text);
    return fault_of(text);
  };
  EXPECT_EQ(with([](CloudText&) {}), Fault::kNoFault);
  EXPECT_EQ(with([](CloudText& t) { t.fields[1].offset = t.fields[2].offset = 0; }),
            Fault::kLayout);
  EXPECT_EQ(with([](CloudText& t) { t.fields[1].offset = 2; }), Fault::kLayout);
  EXPECT_EQ(with([](CloudText& t) { t.fields[3].offset = 8; }), Fault::kLayout) << "rgb over z";
  EXPECT_EQ(with([](CloudText& t) { t.fields[3] = {"normal", 10, 8, 1}; }), Fault::kLayout);
  EXPECT_EQ(with([](CloudText& t) { t.data = turned(t.data, 4); }), Fault::kByteOrder);
  EXPECT_EQ(
      with([](CloudText& t) { t.width = 2, t.height = 2, t.row_step = 80, t.data.resize(160); }),
      Fault::kLayout)
      << "rows of twice as many points";
}

}  // namespace
}  // namespace clearance::layout_test
