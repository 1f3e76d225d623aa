// Messages of cameras as bytes, made by the rules of CDR without the types of the wire.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/monitor/recording/ros_bags.hpp"

namespace clearance::test::camera {

inline constexpr std::int64_t kStart = 1'700'000'000'000'000'000, kFrame = 33'333'333;

// An image of 8 x 6 pixels.
struct ImageText {
  std::uint32_t height = 6, width = 8;
  std::string encoding = "16UC1";
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 16;
  std::vector<std::uint8_t> data = std::vector<std::uint8_t>(16 * 6, 7);
  std::int64_t stamp_ns = kStart;
  std::string frame = "camera";

  [[nodiscard]] std::vector<std::byte> cdr() const {
    RosCdr out;
    out.header(stamp_ns, frame).number(height).number(width).text(encoding);
    out.number(is_bigendian).number(step).number(static_cast<std::uint32_t>(data.size()));
    for (const std::uint8_t byte : data) out.number(byte);
    return out.bytes();
  }
};

struct InfoText {
  std::uint32_t height = 6, width = 8;
  std::vector<double> d = {0, 0, 0, 0, 0};
  std::vector<double> k = {10, 0, 3.5, 0, 11, 2.5, 0, 0, 1};
  std::vector<double> r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::vector<double> p = {10, 0, 3.5, 0, 0, 11, 2.5, 0, 0, 0, 1, 0};
  std::uint32_t binning = 0, x_offset = 0;
  std::int64_t stamp_ns = kStart;
  std::string frame = "camera";

  [[nodiscard]] std::vector<std::byte> cdr() const {
    RosCdr out;
    out.header(stamp_ns, frame).number(height).number(width).text("plumb_bob").numbers(d);
    for (const auto* matrix : {&k, &r, &p}) {
      for (const double x : *matrix) out.number(x);
    }
    out.number(binning).number(binning).number(x_offset).number(std::uint32_t{0});
    out.number(std::uint32_t{0}).number(std::uint32_t{0}).number(std::uint8_t{0});
    return out.bytes();
  }
};

struct FieldText {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 7;
  std::uint32_t count = 1;
};

// Five points of 20 bytes in one row.
struct CloudText {
  std::uint32_t height = 1, width = 5;
  std::vector<FieldText> fields = {{"x", 0}, {"y", 4}, {"z", 8}, {"rgb", 16}};
  std::uint8_t is_bigendian = 0;
  std::uint32_t point_step = 20, row_step = 100;
  std::vector<std::uint8_t> data = std::vector<std::uint8_t>(100, 3);
  std::int64_t stamp_ns = kStart;
  std::string frame = "camera";

  [[nodiscard]] std::vector<std::byte> cdr() const {
    RosCdr out;
    out.header(stamp_ns, frame).number(height).number(width);
    out.number(static_cast<std::uint32_t>(fields.size()));
    for (const FieldText& field : fields) {
      out.text(field.name).number(field.offset).number(field.datatype).number(field.count);
    }
    out.number(is_bigendian).number(point_step).number(row_step);
    out.number(static_cast<std::uint32_t>(data.size()));
    for (const std::uint8_t byte : data) out.number(byte);
    out.number(std::uint8_t{1});
    return out.bytes();
  }
};

// An octomap in its binary form.
inline std::vector<std::byte> map_cdr(const std::string& tree, std::int64_t stamp_ns,
                                      const std::string& id, const std::string& frame,
                                      double resolution) {
  RosCdr out;
  out.header(stamp_ns, frame).number(std::uint8_t{1}).text(id).number(resolution);
  out.number(static_cast<std::uint32_t>(tree.size()));
  for (const char byte : tree) out.number(byte);
  return out.bytes();
}

}  // namespace clearance::test::camera
