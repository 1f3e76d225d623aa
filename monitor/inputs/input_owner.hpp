// The source whose samples are used for one input: an object's poses, a joint's positions, the path
// of a camera's frame, or the batches under one name. It is the source that the cell names, else
// the first one that was heard. Another source may replace the latter after it has been silent for
// long enough. A source whose samples are refused is not silent.
#pragma once

#include <algorithm>
#include <cstdint>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/state_bytes.hpp"

namespace clearance {

// A source that was silent for longer has lost its inputs: others may send them.
inline constexpr std::int64_t kSourceSilentNs = 1'000'000'000;
// Another source that was silent for longer has gone.
inline constexpr std::int64_t kOtherGoneNs = 10 * kSourceSilentNs;

template <class Source, Source kNobody>
class Owner {
 public:
  Owner() = default;

  // The cell states the source, and no other source may replace it.
  explicit Owner(Source source) noexcept : source_(source), is_stated_(true) {}

  // Call this with every sample, also of those that will be refused. Returns true if samples of
  // this source must be refused, and then stores the source. `age_limit_ns` is that of the input.
  // Another source may take over after kSourceSilentNs, or the age limit if that is longer.
  [[nodiscard]] bool refuses(Source source, std::int64_t now_ns,
                             std::int64_t age_limit_ns) noexcept {
    if (source == source_) {
      heard_ns_ = now_ns;
      return false;
    }
    if (!is_held(now_ns, age_limit_ns)) return false;
    other_ = source;
    other_heard_ns_ = now_ns;
    return true;
  }

  // True if the owner keeps others out at this time.
  [[nodiscard]] bool is_held(std::int64_t now_ns, std::int64_t age_limit_ns) const noexcept {
    if (source_ == kNobody) return false;
    return is_stated_ || elapsed(heard_ns_, now_ns) <= std::max(age_limit_ns, kSourceSilentNs);
  }

  // Call this when a sample of this source was taken into use.
  void take(Source source, std::int64_t now_ns) noexcept {
    if (source != source_) {
      if (source_ != kNobody && !is_stated_) {
        former_ = source_;
        ++takeovers_;
      }
      other_ = kNobody;
    }
    source_ = source;
    heard_ns_ = now_ns;
  }

  // The owner does not exist any more.
  void leave() noexcept { source_ = kNobody; }
  // The ages of the last samples are not known any more: they count from now.
  void forget_age(std::int64_t now_ns) noexcept { heard_ns_ = other_heard_ns_ = now_ns; }

  // True if the cell names the source: what others send is then no dispute.
  [[nodiscard]] bool is_stated() const noexcept { return is_stated_; }
  // The number of times that another source has taken over, and the owner before the last of them.
  [[nodiscard]] std::uint32_t takeovers() const noexcept { return takeovers_; }
  [[nodiscard]] Source former_source() const noexcept { return former_; }
  [[nodiscard]] Source source() const noexcept { return source_; }
  // The last source that was refused because it is not the owner. kNobody after the owner changed,
  // and once that source has gone.
  [[nodiscard]] Source other_source(std::int64_t now_ns) const noexcept {
    return elapsed(other_heard_ns_, now_ns) <= kOtherGoneNs ? other_ : kNobody;
  }
  // `own`: what the scene states.
  [[nodiscard]] bool is_sound(const Owner& own) const noexcept {
    return are_flags(is_stated_) && is_stated_ == own.is_stated_ &&
           (!is_stated_ || source_ == own.source_);
  }

 private:
  // The first three are all that a sample of the owner reads and writes.
  Source source_ = kNobody;
  bool is_stated_ = false;
  std::int64_t heard_ns_ = 0;  // last sample of the owner, in the tick's time
  Source other_ = kNobody;
  Source former_ = kNobody;
  std::uint32_t takeovers_ = 0;
  std::int64_t other_heard_ns_ = 0;  // last sample of the other source, in the tick's time
};

using InputOwner = Owner<std::uint32_t, kNoSource>;

}  // namespace clearance
