// The frames of a camera: what is used, and the cause for which each other message is refused.
//
// The bytes are made by the rules of CDR, without the types of the wire. Oracles: the numbers that
// the test put in; and for damaged messages, views that stay within the bytes of the message, which
// sanitizers check where they are read.
#include "monitor/intake/camera_stream.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "monitor/intake/frame_decoders.hpp"
#include "tests/monitor/intake/camera_texts.hpp"
#include "tests/shared/random.hpp"

namespace clearance::camera_stream_test {

namespace {

using test::camera::CloudText;
using test::camera::ImageText;
using test::camera::InfoText;
using test::camera::kFrame;

constexpr std::int64_t kStart = test::camera::kStart;

class CameraStreamTest : public testing::Test {
 protected:
  FrameFault take(const InfoText& text) {
    return decoder.decode(text.cdr(), info) ? stream.take(*info) : FrameFault::kUndecodable;
  }
  FrameFault take(const ImageText& text, std::uint64_t writer = 1) {
    return take(
        text, {.stamp_ns = text.stamp_ns, .sent_ns = text.stamp_ns + 1'000'000, .writer = writer});
  }
  FrameFault take(const ImageText& text, const FrameOrigin& origin) {
    return take(RawSensorMessage::Type::kImage, text.cdr(), origin);
  }
  FrameFault take(const CloudText& text) {
    return take(RawSensorMessage::Type::kPoints, text.cdr(),
                {.stamp_ns = text.stamp_ns, .sent_ns = text.stamp_ns, .writer = 1});
  }
  FrameFault take(RawSensorMessage::Type type, const std::vector<std::byte>& cdr,
                  const FrameOrigin& origin) {
    cloud = frame_decoder(type)->decode({.type = type, .cdr = cdr}, sensor, decoder);
    return stream.take(*cloud, origin);
  }
  // A frame after so many others, with a depth of its own.
  static ImageText frame(int number) {
    ImageText text;
    text.stamp_ns += number * kFrame;
    text.data.assign(text.data.size(), static_cast<std::uint8_t>(number + 1));
    return text;
  }

  CameraStream stream{{.least_interval_ns = 10'000'000}};
  const Sensor sensor = [] {
    Sensor of_hundred;
    of_hundred.most_points = 100;
    return of_hundred;
  }();
  CdrDecoder decoder;
  Sample<sensor_msgs_msg_dds__CameraInfo_> info;
  std::unique_ptr<MessageCloud> cloud;  // of the last message
};

TEST_F(CameraStreamTest, AFrameIsItsPixelsWithTheCameraOfItsInfo) {
  ASSERT_EQ(take(InfoText{}), FrameFault::kNoFault);
  EXPECT_EQ(stream.camera(), (PinholeCamera{8, 6, 10.0, 11.0, 3.5, 2.5}));
  ImageText text;
  text.step = 18;
  text.data.assign(18 * 6 - 2, 9);  // the padding of the last row may be missing
  ASSERT_EQ(take(text), FrameFault::kNoFault);
  EXPECT_EQ(cloud->image()->format, DepthImage::Format::kMillimetres16);
  EXPECT_EQ(cloud->image()->width, 8U);
  EXPECT_EQ(cloud->image()->height, 6U);
  EXPECT_EQ(cloud->image()->step, 18U);
  EXPECT_EQ(stream.stamp_ns(), kStart);
  ImageText metres = frame(1);
  metres.encoding = "32FC1";
  metres.step = 32;
  metres.data.assign(32 * 6, 1);
  stream = CameraStream({});
  ASSERT_EQ(take(InfoText{}), FrameFault::kNoFault);
  ASSERT_EQ(take(metres), FrameFault::kNoFault);
  EXPECT_EQ(cloud->image()->format, DepthImage::Format::kMetres32);
}

TEST_F(CameraStreamTest, ImagesThatLieAboutTheirPixelsAreRefusedByCause) {
  ASSERT_EQ(take(InfoText{}), FrameFault::kNoFault);
  const auto with = [&](const auto& change) {
    ImageText text;
    change(text);
    return take(text);
  };
  using Fault = FrameFault;
  EXPECT_EQ(with([](ImageText& t) { t.encoding = "rgb8"; }), Fault::kEncoding);
  EXPECT_EQ(with([](ImageText& t) { t.encoding = "mono16"; }), Fault::kEncoding);
  EXPECT_EQ(with([](ImageText& t) { t.is_bigendian = 1; }), Fault::kByteOrder);
  EXPECT_EQ(with([](ImageText& t) { t.height = 0; }), Fault::kNoPixels);
  EXPECT_EQ(with([](ImageText& t) { t.step = 0; }), Fault::kStep);
  EXPECT_EQ(with([](ImageText& t) { t.step = 15; }), Fault::kStep);
  EXPECT_EQ(with([](ImageText& t) { t.data.resize(48); }), Fault::kShortData);
  EXPECT_EQ(with([](ImageText& t) { t.data.clear(); }), Fault::kShortData);
  EXPECT_EQ(with([](ImageText& t) { t.step = 0xFFFFFFFF; }), Fault::kShortData);
  EXPECT_EQ(with([](ImageText& t) { t.width = t.height = 0x80000000; }), Fault::kTooManyPixels);
  EXPECT_EQ(with([](ImageText& t) { t.width = 16, t.step = 32, t.data.resize(192); }),
            Fault::kSizeChanged);
  EXPECT_EQ(stream.stamp_ns(), 0) << "none of them is a frame";
  EXPECT_EQ(stream.counts()[static_cast<std::size_t>(Fault::kStep)], 2U);
}

TEST_F(CameraStreamTest, AnImageNeedsACameraInfoThatStaysTheSame) {
  EXPECT_EQ(take(frame(0)), FrameFault::kNoCameraInfo);
  ASSERT_EQ(take(InfoText{}), FrameFault::kNoFault);
  EXPECT_EQ(take(frame(0)), FrameFault::kNoFault);
  InfoText other;
  other.k[0] = other.p[0] = 12;
  EXPECT_EQ(take(other), FrameFault::kCameraInfoChanged);
  EXPECT_EQ(take(frame(1)), FrameFault::kCameraInfoChanged);
  ASSERT_EQ(take(InfoText{}), FrameFault::kNoFault);
  EXPECT_EQ(take(frame(2)), FrameFault::kNoFault);
}

TEST_F(CameraStreamTest, ACameraInfoThatIsNoPlainPinholeIsRefused) {
  const auto with = [&](const auto& change) {
    InfoText text;
    change(text);
    const FrameFault fault = take(text);
    EXPECT_FALSE(stream.camera());
    return fault;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using Fault = FrameFault;
  EXPECT_EQ(with([](InfoText& t) { t.d[1] = 0.01; }), Fault::kDistorted);
  EXPECT_EQ(with([&](InfoText& t) { t.d[1] = nan; }), Fault::kDistorted);
  EXPECT_EQ(with([](InfoText& t) { t.r[1] = 0.01; }), Fault::kDistorted);
  EXPECT_EQ(with([](InfoText& t) { t.binning = 2; }), Fault::kDistorted);
  EXPECT_EQ(with([](InfoText& t) { t.x_offset = 2; }), Fault::kDistorted);
  EXPECT_EQ(with([](InfoText& t) { t.k[0] = 0; }), Fault::kIntrinsics);
  EXPECT_EQ(with([](InfoText& t) { t.k[4] = -1; }), Fault::kIntrinsics);
  EXPECT_EQ(with([&](InfoText& t) { t.k[2] = nan; }), Fault::kIntrinsics);
  EXPECT_EQ(with([](InfoText& t) { t.p[0] = 9; }), Fault::kIntrinsics);
  EXPECT_EQ(with([](InfoText& t) { t.p[3] = -0.4; }), Fault::kIntrinsics) << "a stereo baseline";
  EXPECT_EQ(with([](InfoText& t) { t.p[7] = 0.4; }), Fault::kIntrinsics) << "a vertical one";
  EXPECT_EQ(with([](InfoText& t) { t.width = 0; }), Fault::kNoPixels);
}

TEST_F(CameraStreamTest, ADepthThatRepeatsUnderFreshStampsIsFrozenUnlessItMay) {
  ASSERT_EQ(take(InfoText{}), FrameFault::kNoFault);
  ASSERT_EQ(take(frame(0)), FrameFault::kNoFault);
  ImageText same = frame(0);
  same.stamp_ns += kFrame;
  EXPECT_EQ(take(same), FrameFault::kFrozen);
  EXPECT_EQ(stream.stamp_ns(), kStart) << "the frame in use grows old";
  ImageText one_pixel = same;
  one_pixel.stamp_ns += kFrame;
  one_pixel.data[37] ^= 1;
  EXPECT_EQ(take(one_pixel), FrameFault::kNoFault);
  // A driver that hangs sends its two buffers in turn.
  for (ImageText buffer : {same, one_pixel, same}) {
    buffer.stamp_ns = one_pixel.stamp_ns += kFrame;
    EXPECT_EQ(take(buffer), FrameFault::kFrozen);
  }
  stream = CameraStream({.may_repeat = true});
  ASSERT_EQ(take(InfoText{}), FrameFault::kNoFault);
  ASSERT_EQ(take(frame(0)), FrameFault::kNoFault);
  EXPECT_EQ(take(same), FrameFault::kNoFault);
}

TEST_F(CameraStreamTest, AnImageIsRefusedWithTheCameraInfoOfAnotherFrame) {
  InfoText said;
  said.frame = "colour";
  ASSERT_EQ(take(said), FrameFault::kNoFault);
  ImageText picture = frame(0);
  picture.frame = "depth";
  EXPECT_EQ(take(picture), FrameFault::kOtherCamera);
  picture.frame = "";
  EXPECT_EQ(take(picture), FrameFault::kNoFault) << "it says nothing";
  said.frame = "depth";
  EXPECT_EQ(take(said), FrameFault::kCameraInfoChanged) << "two cameras on one topic";
}

TEST_F(CameraStreamTest, AnImageOfAnotherFormThanTheFirstIsRefusedUntilTheFirstComesAgain) {
  ASSERT_EQ(take(InfoText{}), FrameFault::kNoFault);
  ASSERT_EQ(take(frame(0)), FrameFault::kNoFault);
  int number = 0;
  const auto with = [&](const auto& change) {
    ImageText text = frame(++number);
    change(text);
    return take(text);
  };
  const auto as_metres = [](ImageText& t) {
    t.encoding = "32FC1", t.step = 32, t.data.assign(32 * 6, 1);
  };
  EXPECT_EQ(with(as_metres), FrameFault::kFormChanged);
  EXPECT_EQ(with([](ImageText& t) { t.step = 24, t.data.resize(24 * 6, 9); }),
            FrameFault::kFormChanged);
  EXPECT_EQ(with([](ImageText& t) { t.frame = ""; }), FrameFault::kNoFault) << "it says nothing";
  // An image that was refused states nothing.
  stream = CameraStream({});
  ASSERT_EQ(take(InfoText{}), FrameFault::kNoFault);
  ImageText unstamped = frame(0);
  as_metres(unstamped);
  unstamped.stamp_ns = 0;
  ASSERT_EQ(take(unstamped), FrameFault::kNoStamp);
  EXPECT_EQ(with([](ImageText&) {}), FrameFault::kNoFault);
}

TEST_F(CameraStreamTest, PointsOfAnotherFrameOrFormThanTheFirstAreRefusedUntilTheFirstComeAgain) {
  CloudText first;
  ASSERT_EQ(take(first), FrameFault::kNoFault);
  int number = 0;
  const auto with = [&](const auto& change) {
    CloudText text = first;
    text.stamp_ns += ++number * kFrame;
    text.data[0] = static_cast<std::uint8_t>(100 + number);
    change(text);
    return take(text);
  };
  using Fault = FrameFault;
  EXPECT_EQ(with([](CloudText& t) { t.frame = "base"; }), Fault::kFrameChanged);
  EXPECT_EQ(with([](CloudText& t) { t.fields[0].offset = 12; }), Fault::kFormChanged);
  EXPECT_EQ(with([](CloudText& t) { std::swap(t.fields[0].offset, t.fields[1].offset); }),
            Fault::kFormChanged);
  EXPECT_EQ(with([](CloudText& t) { t.point_step = 16, t.row_step = 80, t.fields.pop_back(); }),
            Fault::kFormChanged);
  EXPECT_EQ(with([](CloudText& t) { t.height = 5, t.width = 1, t.row_step = 20; }),
            Fault::kFormChanged);
  EXPECT_EQ(with([](CloudText& t) { t.width = 4, t.row_step = 80; }), Fault::kNoFault)
      << "fewer points in one row";
  EXPECT_EQ(with([](CloudText& t) { t.frame = "/camera"; }), Fault::kNoFault);
  EXPECT_EQ(with([](CloudText& t) {
              t.fields.insert(t.fields.begin(), {"ring", 12});
            }),
            Fault::kNoFault)
      << "x, y and z are where they were";
  first.height = 5, first.width = 1, first.row_step = 20;
  stream = CameraStream({});
  ASSERT_EQ(with([](CloudText&) {}), Fault::kNoFault);
  EXPECT_EQ(with([](CloudText& t) { t.height = 4; }), Fault::kFormChanged) << "organised";
}

// The colours of each point go on.
TEST_F(CameraStreamTest, PointsThatRepeatAreFrozenWhateverTheirColours) {
  CloudText text;
  ASSERT_EQ(take(text), FrameFault::kNoFault);
  text.stamp_ns += kFrame;
  text.data[16] ^= 7;
  EXPECT_EQ(take(text), FrameFault::kFrozen);
  EXPECT_EQ(stream.stamp_ns(), kStart) << "the frame in use grows old";
  for (const std::size_t byte : {20U, 24U, 28U}) {  // x, y and z of the second point
    text.stamp_ns += kFrame;
    text.data[byte] ^= 7;
    EXPECT_EQ(take(text), FrameFault::kNoFault) << byte;
  }
}

TEST_F(CameraStreamTest, FramesComeInTheOrderOfTheirStampsFromOneClockAndOnePublisher) {
  ASSERT_EQ(take(InfoText{}), FrameFault::kNoFault);
  ImageText unstamped = frame(0);
  unstamped.stamp_ns = 0;
  EXPECT_EQ(take(unstamped, {0, kStart, 1}), FrameFault::kNoStamp);
  EXPECT_EQ(take(frame(0), {1'000'000'000, kStart, 1}), FrameFault::kOtherClock);
  EXPECT_EQ(take(frame(0), {std::numeric_limits<std::int64_t>::max(), -kStart, 1}),
            FrameFault::kOtherClock);
  ASSERT_EQ(take(frame(5)), FrameFault::kNoFault);
  EXPECT_EQ(take(frame(4)), FrameFault::kOldStamp);
  EXPECT_EQ(take(frame(5)), FrameFault::kOldStamp);
  EXPECT_EQ(take(frame(6), 2), FrameFault::kSecondPublisher);
  ImageText soon = frame(6);
  soon.stamp_ns = frame(5).stamp_ns + kFrame / 10;
  EXPECT_EQ(take(soon), FrameFault::kTooOften);
  EXPECT_EQ(take(frame(6)), FrameFault::kNoFault);
  // After half a second of silence another publisher has the stream.
  EXPECT_EQ(take(frame(22), 2), FrameFault::kNoFault);
  EXPECT_EQ(take(frame(23), 1), FrameFault::kSecondPublisher);
}

// The camera's own clock, or that of this machine in a log.
TEST_F(CameraStreamTest, AClockThatWasSetBackCostsHalfASecondAndNotTheWholeStep) {
  ASSERT_EQ(take(InfoText{}), FrameFault::kNoFault);
  ASSERT_EQ(take(frame(200)), FrameFault::kNoFault);
  const std::int64_t sent = frame(200).stamp_ns;
  EXPECT_EQ(take(frame(100), {frame(100).stamp_ns, sent + kFrame, 1}), FrameFault::kOldStamp);
  EXPECT_EQ(take(frame(115), {frame(115).stamp_ns, sent + 16 * kFrame, 1}), FrameFault::kNoFault);
  EXPECT_EQ(take(frame(116), {frame(116).stamp_ns, sent + 17 * kFrame, 1}), FrameFault::kNoFault);
  EXPECT_EQ(take(frame(20)), FrameFault::kNoFault) << "the time of sending was set back, too";
  EXPECT_EQ(take(frame(19)), FrameFault::kOldStamp);
}

TEST_F(CameraStreamTest, CloudsThatLieAboutTheirFieldsAreRefusedByCause) {
  const auto with = [&](const auto& change) {
    CloudText text;
    change(text);
    return take(text);
  };
  using Fault = FrameFault;
  EXPECT_EQ(with([](CloudText& t) { t.fields.erase(t.fields.begin() + 2); }), Fault::kFields);
  EXPECT_EQ(with([](CloudText& t) { t.fields[1].datatype = 8; }), Fault::kFields);
  EXPECT_EQ(with([](CloudText& t) { t.fields[1].count = 2; }), Fault::kFields);
  EXPECT_EQ(with([](CloudText& t) { t.fields[2].offset = 17; }), Fault::kFields);
  EXPECT_EQ(with([](CloudText& t) { t.fields[2].offset = 0xFFFFFFFE; }), Fault::kFields);
  EXPECT_EQ(with([](CloudText& t) { t.fields[3].name = "x"; }), Fault::kFields);
  EXPECT_EQ(with([](CloudText& t) { t.fields[3] = {"t", 16, 4}; }), Fault::kFields);
  EXPECT_EQ(with([](CloudText& t) { t.fields[3] = {"timestamp", 16, 8}; }), Fault::kFields);
  EXPECT_EQ(with([](CloudText& t) { t.point_step = 0; }), Fault::kFields);
  EXPECT_EQ(with([](CloudText& t) { t.is_bigendian = 1; }), Fault::kByteOrder);
  EXPECT_EQ(with([](CloudText& t) { t.width = 0; }), Fault::kNoPixels);
  EXPECT_EQ(with([](CloudText& t) { t.width = 101; }), Fault::kTooManyPixels);
  EXPECT_EQ(with([](CloudText& t) { t.width = 6; }), Fault::kShortData);
  EXPECT_EQ(with([](CloudText& t) { t.height = 2, t.row_step = 0; }), Fault::kStep);
  EXPECT_EQ(with([](CloudText& t) { t.height = 2; }), Fault::kShortData);
  ASSERT_EQ(with([](CloudText& t) { t.row_step = 0; }), Fault::kNoFault) << "one row needs no step";
  EXPECT_EQ(cloud->columns, 5U);
}

// Reads everything that a view names.
template <class View>
std::size_t sum_of(const View& view, std::size_t row, std::size_t step) {
  std::size_t sum = 0;
  for (std::uint32_t v = 0; v < view.height; ++v) {
    for (const std::byte byte : view.bytes.subspan(v * step, row)) {
      sum += std::to_integer<std::size_t>(byte);
    }
  }
  return sum;
}

TEST_F(CameraStreamTest, DamagedBytesAreRefusedOrNameOnlyWhatIsThere) {
  Random random(36);
  const std::vector<std::byte> messages[] = {ImageText{}.cdr(), InfoText{}.cdr(),
                                             CloudText{}.cdr()};
  std::size_t refused = 0, used = 0;
  Sample<sensor_msgs_msg_dds__Image_> image;
  Sample<sensor_msgs_msg_dds__PointCloud2_> clouds;
  DepthImage seen;
  PointsView points;
  for (int round = 0; round < 60'000; ++round) {
    const int kind = round % 3;
    std::vector<std::byte> bytes = messages[kind];
    const int last = static_cast<int>(bytes.size()) - 1;
    for (int i = random.integer(1, 4); i > 0; --i) {
      const auto at = static_cast<std::size_t>(random.integer(0, last));
      bytes[at] = static_cast<std::byte>(random.chance(0.3) ? 0xFF : random.integer(0, 255));
    }
    if (random.chance(0.2)) bytes.resize(static_cast<std::size_t>(random.integer(0, last)));
    FrameFault fault = FrameFault::kUndecodable;

    if (kind == 0 && decoder.decode(bytes, image)) {
      fault = view(*image, 100, seen);
      if (fault == FrameFault::kNoFault) {
        const bool is_millimetres = seen.format == DepthImage::Format::kMillimetres16;
        EXPECT_LE(sum_of(seen, seen.width * (is_millimetres ? 2U : 4U), seen.step), 255U * 400U);
      }
    } else if (kind == 1 && decoder.decode(bytes, info)) {
      fault = stream.take(*info);
    } else if (kind == 2 && decoder.decode(bytes, clouds)) {
      fault = view(*clouds, 100, points);
      if (fault == FrameFault::kNoFault) {
        EXPECT_LE(sum_of(points, points.width * points.point_step, points.row_step), 255U * 100U);
      }
    }
    ++(fault == FrameFault::kNoFault ? used : refused);
  }
  EXPECT_GT(refused, 1000U);
  EXPECT_GT(used, 1000U) << "much of a message is depth, which may be anything";
}

TEST(FrameFault, EveryCauseHasATextOfItsOwn) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < kFrameFaults; ++i) {
    texts.emplace_back(text(static_cast<FrameFault>(i)));
    EXPECT_FALSE(texts.back().empty()) << i;
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(texts[k], texts[i]);
  }
}

}  // namespace
}  // namespace clearance::camera_stream_test
