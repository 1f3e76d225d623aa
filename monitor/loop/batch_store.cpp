#include "monitor/loop/batch_store.hpp"

#include <algorithm>
#include <ranges>

#include "monitor/inputs/checksum.hpp"

namespace clearance {
namespace {

// A partner that joins catches up with the ticks since its state was taken: for this it needs their
// batches. 64 are enough for 16 sources during 4 ms; small cells keep many more.
constexpr std::size_t kLeastBatches = 64, kMostBatches = 512, kMostBytes = 64 << 20;

std::size_t batches_of(const BatchStore::Size& size) noexcept {
  const std::size_t bytes =
      1 + size.samples * sizeof(PoseSample) + size.joints * sizeof(JointSample);
  return std::clamp(kMostBytes / bytes, kLeastBatches, kMostBatches);
}

}  // namespace

std::uint64_t content_of(const PoseBatch& batch) noexcept {
  Checksum sum;
  sum.add(batch.scene_revision);
  sum.add(batch.samples.size());
  for (const PoseSample& sample : batch.samples) {
    sum.add(sample.object);
    sum.add(sample.stamp_ns);
    sum.add_pose(sample.world_from_object);
    sum.add(sample.has_twist);
    if (!sample.has_twist) continue;
    sum.add3(sample.twist.linear);
    sum.add3(sample.twist.angular);
  }
  for (const JointSample& sample : batch.joints) {
    sum.add(sample.variable);
    sum.add(sample.stamp_ns);
    sum.add(sample.position);
    sum.add(sample.has_velocity);
    if (sample.has_velocity) sum.add(sample.velocity);
    sum.add(sample.stopping);
  }
  return sum.value();
}

BatchStore::BatchStore(PoseSource& source, const Size& size)
    : source_(source),
      most_samples_(kLargestBatchesATick * (size.samples + size.joints)),
      slots_(batches_of(size)) {
  for (Stored& stored : slots_) {
    stored.batch.samples.reserve(size.samples);
    stored.batch.joints.reserve(size.joints);
  }
}

void BatchStore::take_in() noexcept {
  while (const PoseBatch* batch = source_.next()) {
    if (tail_ - head_ == slots_.size()) ++head_;
    Stored& stored = at(tail_++);
    stored.batch = *batch;
    stored.content = batch->content != 0 ? batch->content : content_of(*batch);
    stored.waits = true;
    stored.given = false;
  }
}

void BatchStore::choose_all(bool keep) noexcept {
  count_ = given_ = 0;
  std::size_t samples = 0;
  for (std::uint64_t place = head_; place < tail_ && count_ < kMostTickInputs; ++place) {
    Stored& stored = at(place);
    const bool is_new = stored.waits && !stored.given;
    if (is_new && samples + stored.batch.size() > most_samples_) break;
    if (!keep) stored.waits = false;
    if (!is_new) continue;
    samples += stored.batch.size();
    stored.given = true;
    places_[count_] = place;
    inputs_[count_++] = {stored.batch.source, stored.batch.sequence_number, stored.content};
  }
  while (head_ < tail_ && !at(head_).waits) ++head_;
}

// Returns tail_ if it has not come.
std::uint64_t BatchStore::find(const TickInput& input) noexcept {
  for (std::uint64_t place = head_; place < tail_; ++place) {
    const Stored& stored = at(place);
    if (stored.waits && stored.content == input.content && stored.batch.source == input.source)
      return place;
  }
  return tail_;
}

// The leader has not had, and will not use, the batches of a source before one that it names.
bool BatchStore::choose(std::span<const TickInput> inputs) noexcept {
  count_ = given_ = 0;
  for (const TickInput& input : inputs) {
    const std::uint64_t place = find(input);
    if (place == tail_) {
      for (std::size_t i = 0; i < count_; ++i) at(places_[i]).waits = true;
      count_ = 0;
      return false;
    }
    at(place).waits = false;
    places_[count_] = place;
    inputs_[count_++] = input;
  }
  for (std::size_t i = 0; i < count_; ++i) {
    at(places_[i]).batch.sequence_number = inputs_[i].sequence_number;
    for (std::uint64_t place = head_; place < places_[i]; ++place) {
      if (at(place).batch.source == inputs_[i].source) at(place).waits = false;
    }
  }
  while (head_ < tail_ && !at(head_).waits) ++head_;
  return true;
}

void BatchStore::begin_again() noexcept {
  forgotten_count_ = 0;
  for (std::uint64_t place = head_; place < tail_; ++place) at(place).given = false;
}

void BatchStore::forget(std::span<const TickInput> inputs) noexcept {
  for (const TickInput& input : std::views::reverse(inputs)) {
    const auto done = std::span(forgotten_).first(forgotten_count_);
    if (std::ranges::find(done, input.source) != done.end()) continue;
    const std::uint64_t place = find(input);
    if (place == tail_) continue;
    for (std::uint64_t each = head_; each <= place; ++each) {
      if (at(each).batch.source == input.source) at(each).waits = false;
    }
    if (forgotten_count_ < forgotten_.size()) forgotten_[forgotten_count_++] = input.source;
  }
}

// Slots are filled again in take_in() only, which is not called before the tick has had them all.
const PoseBatch* BatchStore::next() noexcept {
  return given_ == count_ ? nullptr : &at(places_[given_++]).batch;
}

}  // namespace clearance
