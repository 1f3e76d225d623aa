// The batches that have come and that no agreed tick has used yet. A follower takes those out that
// the leader names, whatever order they came in here.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "monitor/loop/ports.hpp"
#include "monitor/loop/tick_notice.hpp"

namespace clearance {

// A checksum of the samples of a batch, without its sender and its number: some decoders count for
// themselves.
[[nodiscard]] std::uint64_t content_of(const PoseBatch& batch) noexcept;

// Tick thread. Allocates nothing after construction.
class BatchStore {
 public:
  struct Size {
    std::size_t samples = 0, joints = 0;  // of the largest batch
  };
  BatchStore(PoseSource& source, const Size& size);

  // Takes in what the source has. If too many batches wait, the oldest ones go.
  void take_in() noexcept;
  // Chooses the batches that no tick has had, in the order in which they came, as many as fit into
  // a tick. `keep`: an agreed tick may use them later.
  void choose_all(bool keep) noexcept;
  // Chooses these. Returns false, and chooses none, if one has not come.
  [[nodiscard]] bool choose(std::span<const TickInput> inputs) noexcept;
  // Whether all of these have come, and wait for an agreed tick.
  [[nodiscard]] bool has(std::span<const TickInput> inputs) noexcept {
    return std::ranges::all_of(inputs, [this](const auto& input) { return find(input) != tail_; });
  }
  // When this daemon joins the partner's state: begin_again(), then forget() with the inputs of
  // each notice up to that state, the newest notice first. The state rests on the batches that
  // these notices name, and on no other batch that waits here. For each source, forget() removes
  // the first batch that it finds with all earlier ones, and ignores the source in older notices.
  void begin_again() noexcept;
  void forget(std::span<const TickInput> inputs) noexcept;
  // The last choice.
  [[nodiscard]] std::span<const TickInput> chosen() const noexcept {
    return std::span(inputs_).first(count_);
  }
  // The chosen batches one after another, with the numbers that the notice has for them; then null.
  const PoseBatch* next() noexcept;

 private:
  struct Stored {
    PoseBatch batch;
    std::uint64_t content = 0;
    bool waits = false;  // no agreed tick has used it
    bool given = false;  // a tick that was not agreed has used it
  };
  [[nodiscard]] Stored& at(std::uint64_t place) noexcept { return slots_[place % slots_.size()]; }
  [[nodiscard]] std::uint64_t find(const TickInput& input) noexcept;

  PoseSource& source_;
  std::size_t most_samples_;  // of a tick
  std::vector<Stored> slots_;
  std::uint64_t head_ = 0, tail_ = 0;  // places; the former is the oldest one
  std::array<std::uint64_t, kMostTickInputs> places_{};
  std::array<TickInput, kMostTickInputs> inputs_;
  std::size_t count_ = 0, given_ = 0;
  std::array<SourceName, kMaxSources> forgotten_;  // since begin_again()
  std::size_t forgotten_count_ = 0;
};

}  // namespace clearance
