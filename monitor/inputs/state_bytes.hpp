// The state of a monitor as bytes, for a monitor of the same scene in the same build elsewhere.
// Both sides go through the same lists in the same order.
//
// Bytes from elsewhere may be forged. So what was taken is checked before it is used (`is_sound`):
// flags and enumerators are some, indices are of the scene, poses, positions and bounds are such,
// and what the scene determines is what this scene has. Stamps and histories may be any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace clearance {

// Appends the values of lists. They hold neither pointers nor memory of their own.
class StateWriter {
 public:
  explicit StateWriter(std::vector<std::byte>& bytes) : bytes_(bytes) {}

  template <class T>
  void put(std::span<const T> values) {
    const std::uint64_t count = values.size();
    append(&count, sizeof count);
    append(values.data(), values.size_bytes());
  }
  template <class T>
  void put(const T& value) {
    put(std::span(&value, 1));
  }

 private:
  void append(const void* from, std::size_t size) {
    const auto* const first = static_cast<const std::byte*>(from);
    bytes_.insert(bytes_.end(), first, first + size);
  }

  std::vector<std::byte>& bytes_;
};

// True if the bytes of these are those of flags. Another byte must not be read as one.
template <class... Flags>
[[nodiscard]] bool are_flags(const Flags&... flags) noexcept {
  const auto is_flag = [](const bool& flag) {
    unsigned char byte = 0;
    std::memcpy(&byte, &flag, 1);
    return byte <= 1;
  };
  return (is_flag(flags) && ...);
}

// Takes them out again. A list of another length, bytes that end too early, or a value that is not
// sound fail this and all later calls.
class StateReader {
 public:
  explicit StateReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  void take(std::span<T> values) noexcept {
    std::uint64_t count = 0;
    copy(&count, sizeof count);
    good_ = good_ && count == values.size();
    copy(values.data(), values.size_bytes());
  }
  template <class T>
  void take(T& value) noexcept {
    take(std::span(&value, 1));
  }
  // A list of any length up to `most`. May allocate.
  template <class T>
  void take_list(std::vector<T>& values, std::size_t most) {
    std::uint64_t count = 0;
    copy(&count, sizeof count);
    good_ = good_ && count <= most;
    if (!good_) return;
    values.resize(count);
    copy(values.data(), count * sizeof(T));
  }
  // What was taken is refused unless this holds.
  void expect(bool is_sound) noexcept { good_ = good_ && is_sound; }
  [[nodiscard]] bool good() const noexcept { return good_; }
  // True if everything was taken, and nothing remains.
  [[nodiscard]] bool complete() const noexcept { return good_ && bytes_.empty(); }

 private:
  void copy(void* to, std::size_t size) noexcept {
    good_ = good_ && bytes_.size() >= size;
    if (!good_ || size == 0) return;
    std::memcpy(to, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }

  std::span<const std::byte> bytes_;
  bool good_ = true;
};

}  // namespace clearance
