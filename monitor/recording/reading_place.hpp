// Where in a recording a viewer reads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "monitor/files/reader.hpp"

namespace clearance {

// A viewer reads on. Where its time goes back or far ahead, it begins anew, a little before.
class ReadingPlace {
 public:
  // `look_back_ns`: messages of this time before its own still say what is there.
  explicit ReadingPlace(std::int64_t look_back_ns) : look_back_ns_(look_back_ns) {}

  // Goes to this time. Returns where to begin anew; nothing: what follows is read.
  [[nodiscard]] std::optional<McapWindow> go_to(std::int64_t time_ns) {
    const bool follows =
        read_ns_ && time_ns >= *read_ns_ && time_ns <= *read_ns_ + 2 * look_back_ns_;
    read_ns_ = time_ns;
    if (follows) return std::nullopt;
    const std::int64_t begin_ns = std::max<std::int64_t>(0, time_ns - look_back_ns_);
    return McapWindow{.start_ns = static_cast<std::uint64_t>(begin_ns)};
  }
  // The next time is begun with anew.
  void forget() { read_ns_.reset(); }

 private:
  std::int64_t look_back_ns_;
  std::optional<std::int64_t> read_ns_;  // all before this time was read
};

}  // namespace clearance
