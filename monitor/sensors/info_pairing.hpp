// Tells whether the CameraInfo of an image is still to come. Most drivers send one with each image,
// with the same stamp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace clearance {

class InfoPairing {
 public:
  void take_image(std::int64_t stamp_ns) noexcept {
    images_[next_++ % images_.size()] = stamp_ns;
    if (stamp_ns == info_ns_) pair();
  }
  void take_info(std::int64_t stamp_ns) noexcept {
    if (stamp_ns == info_ns_) return;
    if (!is_paired_ && ++alone_ >= kAlone) pairs_ = 0;
    info_ns_ = stamp_ns;
    is_paired_ = false;
    if (std::ranges::find(images_, stamp_ns) != images_.end()) pair();
  }
  // True if infos come with the stamps of images, and that of this image has not come.
  [[nodiscard]] bool is_awaited(std::int64_t image_ns) const noexcept {
    return pairs_ >= kPairs && info_ns_ < image_ns;
  }

 private:
  // Pairs that show that infos belong to images, and infos without an image that show the opposite:
  // a few images are lost now and then.
  static constexpr int kPairs = 2, kAlone = 8;

  void pair() noexcept {
    if (is_paired_) return;
    is_paired_ = true;
    alone_ = 0;
    pairs_ = std::min(pairs_ + 1, kPairs);
  }

  std::array<std::int64_t, 8> images_{};  // the last ones
  std::size_t next_ = 0;
  std::int64_t info_ns_ = -1;
  bool is_paired_ = false;
  int pairs_ = 0, alone_ = 0;
};

}  // namespace clearance
