// A checksum of values, the same on every machine. One changed bit always changes it, because every
// step is a bijection of what came before.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace clearance {

class Checksum {
 public:
  void add(std::uint64_t word) noexcept {
    value_ = std::rotl((value_ ^ word) * 0x9e3779b97f4a7c15U, 29);
  }
  void add(double value) noexcept { add(std::bit_cast<std::uint64_t>(value)); }
  template <class T>
  requires(std::is_enum_v<T> || (std::is_integral_v<T> &&
                                 !std::is_same_v<T, std::uint64_t>)) void add(T value) noexcept {
    add(static_cast<std::uint64_t>(value));
  }
  template <class Vector>
  void add3(const Vector& v) noexcept {
    add(v.x());
    add(v.y());
    add(v.z());
  }
  template <class Pose>
  void add_pose(const Pose& pose) noexcept {
    add3(pose.position);
    add3(pose.orientation);
    add(pose.orientation.w());
  }
  void add_bytes(std::span<const std::byte> bytes) noexcept {
    std::size_t at = 0;
    for (; at + 8 <= bytes.size(); at += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data() + at, 8);
      add(word);
    }
    for (; at < bytes.size(); ++at) add(static_cast<std::uint8_t>(bytes[at]));
  }
  // Never 0, which stands for none.
  [[nodiscard]] std::uint64_t value() const noexcept { return value_ == 0 ? 1 : value_; }

 private:
  std::uint64_t value_ = 0x243f6a8885a308d3U;
};

[[nodiscard]] inline std::uint64_t checksum_of(std::span<const std::byte> bytes) noexcept {
  Checksum sum;
  sum.add_bytes(bytes);
  return sum.value();
}

}  // namespace clearance
