#include "monitor/bags/ros_messages.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

namespace clearance {
namespace {

// Reads CDR fields one after the other. What is not there reads as zero or empty, and turns ok()
// false for good.
class CdrFields {
 public:
  // The header is 4 bytes: 00, 00 or 01 (CDR, big or little endian), two of options. Alignment is
  // counted from behind it.
  explicit CdrFields(std::span<const std::byte> cdr) {
    ok_ = cdr.size() >= 4 && cdr[0] == std::byte{0} && cdr[1] <= std::byte{1};
    if (!ok_) return;
    swapped_ = (cdr[1] == std::byte{1}) != (std::endian::native == std::endian::little);
    bytes_ = cdr.subspan(4);
  }

  [[nodiscard]] bool ok() const noexcept { return ok_; }

  template <class Number>
  [[nodiscard]] Number get() noexcept {
    static_assert(std::is_arithmetic_v<Number>);
    Number value{};
    const auto raw = aligned(sizeof(Number), 1);
    if (raw.empty()) return value;
    std::array<std::byte, sizeof(Number)> copy;
    std::ranges::copy(raw, copy.begin());
    if (swapped_) std::ranges::reverse(copy);
    std::memcpy(&value, copy.data(), sizeof(Number));
    return value;
  }

  // Its length counts the closing zero.
  [[nodiscard]] std::string text() {
    const auto raw = aligned(1, get<std::uint32_t>());
    const auto* const begin = reinterpret_cast<const char*>(raw.data());
    return {begin, std::find(begin, begin + raw.size(), '\0')};
  }

  // The number of entries, each of which takes at least `bytes`: never more than can follow.
  [[nodiscard]] std::uint32_t count(std::size_t bytes) noexcept {
    const auto entries = get<std::uint32_t>();
    if (entries > (bytes_.size() - place_) / bytes) ok_ = false;
    return ok_ ? entries : 0;
  }

  [[nodiscard]] std::vector<double> numbers() {
    std::vector<double> values(count(sizeof(double)));
    for (double& value : values) value = get<double>();
    return values;
  }

  // builtin_interfaces/msg/Time: s, ns.
  [[nodiscard]] std::int64_t stamp_ns() noexcept {
    const auto seconds = get<std::int32_t>();
    const auto nanoseconds = get<std::uint32_t>();
    return std::int64_t{seconds} * 1'000'000'000 + std::int64_t{nanoseconds};
  }

 private:
  [[nodiscard]] std::span<const std::byte> aligned(std::size_t size, std::size_t entries) noexcept {
    const std::size_t begin = (place_ + size - 1) / size * size;
    if (!ok_ || begin > bytes_.size() || size * entries > bytes_.size() - begin) {
      ok_ = false;
      return {};
    }
    place_ = begin + size * entries;
    return bytes_.subspan(begin, size * entries);
  }

  std::span<const std::byte> bytes_;
  std::size_t place_ = 0;
  bool ok_ = false;
  bool swapped_ = false;
};

// What an entry takes at least: the length of a text; a time, two texts, seven numbers.
constexpr std::size_t kLeastText = 4;
constexpr std::size_t kLeastTransform = 8 + 2 * kLeastText + 7 * 8;

RosTransform transform_of(CdrFields& fields) {
  RosTransform transform;
  transform.stamp_ns = fields.stamp_ns();
  transform.parent = fields.text();
  transform.child = fields.text();
  Vec3& position = transform.parent_from_child.position;
  for (int i = 0; i < 3; ++i) position[i] = fields.get<double>();
  Eigen::Vector4d coefficients;  // x, y, z, w, as in Eigen
  for (int i = 0; i < 4; ++i) coefficients[i] = fields.get<double>();
  transform.parent_from_child.orientation.coeffs() = coefficients;
  return transform;
}

}  // namespace

std::optional<RosJointState> ros_joint_state(std::span<const std::byte> cdr) {
  CdrFields fields(cdr);
  RosJointState state;
  state.stamp_ns = fields.stamp_ns();
  state.frame = fields.text();
  state.name.resize(fields.count(kLeastText));
  for (std::string& name : state.name) name = fields.text();
  state.position = fields.numbers();
  state.velocity = fields.numbers();
  state.effort = fields.numbers();
  return fields.ok() ? std::optional(std::move(state)) : std::nullopt;
}

std::optional<std::vector<RosTransform>> ros_transforms(std::span<const std::byte> cdr) {
  CdrFields fields(cdr);
  std::vector<RosTransform> transforms(fields.count(kLeastTransform));
  for (RosTransform& transform : transforms) transform = transform_of(fields);
  return fields.ok() ? std::optional(std::move(transforms)) : std::nullopt;
}

std::optional<std::string> ros_string(std::span<const std::byte> cdr) {
  CdrFields fields(cdr);
  std::string text = fields.text();
  return fields.ok() ? std::optional(std::move(text)) : std::nullopt;
}

}  // namespace clearance
