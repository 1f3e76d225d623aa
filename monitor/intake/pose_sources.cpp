#include "monitor/intake/pose_sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace clearance {
namespace {

// A million batches last a quarter of an hour at 1 kHz: no source loses so many in a row.
constexpr std::uint64_t kCountsAnew = 1'000'000;

std::uint64_t writer_of(const SourceTally& tally) noexcept { return tally.writer.source(); }

}  // namespace

SourceName name_of_writer(std::string_view name, std::size_t number) {
  return number > 1 ? SourceName(fmt::format("{}#{}", name, number)) : SourceName(name);
}

const char* name(SourceRefusal cause) noexcept {
  switch (cause) {
    case SourceRefusal::kTooMany:
      return "one source too many";
    case SourceRefusal::kOtherWriter:
      return "another writer's name";
    case SourceRefusal::kNoName:
      return "a source without a name";
  }
  return "";
}

void SourceTally::note_sequence(std::uint64_t number) noexcept {
  if (number == 0) return;
  const bool ahead = last_ns != 0 && number > last_sequence;
  if (ahead && number - last_sequence < kCountsAnew) lost += number - last_sequence - 1;
  last_sequence = number;
}

PoseSources::PoseSources(std::vector<SourceName> named) : named_(std::move(named)) {
  tallies_.reserve(kMaxSources);
  refused_.reserve(2 * kMaxSources + 2);
}

Admission PoseSources::admit(const SourceName& source, std::uint64_t writer, std::size_t poses,
                             std::int64_t monotonic_ns) {
  if (source.view().empty()) return refuse(source, SourceRefusal::kNoName, poses);
  const auto known = std::ranges::find(tallies_, source, &SourceTally::source);
  if (known != tallies_.end()) {
    SourceTally& tally = *known;
    const std::uint64_t former = tally.writer.source();
    if (tally.writer.refuses(writer, monotonic_ns, 0)) {
      Admission refusal = refuse(source, SourceRefusal::kOtherWriter, poses);
      refusal.former_writer = former;
      return refusal;
    }
    if (former == writer) return {.tally = &tally};
    tally.writer.take(writer, monotonic_ns);
    tally.last_ns = 0;  // numbers of two writers are unrelated
    return {.tally = &tally, .news = Admission::News::kTakenOver, .former_writer = former};
  }
  SourceTally fresh{.source = source};
  fresh.writer.take(writer, monotonic_ns);
  if (is_named(source) || places_for_others() > 0) {
    return {.tally = &tallies_.emplace_back(fresh), .news = Admission::News::kNewSource};
  }
  SourceTally* const place = free_place(monotonic_ns);
  if (place == nullptr) return refuse(source, SourceRefusal::kTooMany, poses);
  departed_.batches += place->batches;
  departed_.lost += place->lost;
  const SourceName before = place->source;
  *place = fresh;
  return {.tally = place, .news = Admission::News::kNewSource, .place_of = before};
}

SourceName PoseSources::name_for(const SourceName& source, std::uint64_t writer,
                                 std::int64_t monotonic_ns) const {
  for (std::size_t number = 1;; ++number) {
    const SourceName name = name_of_writer(source.view(), number);
    const auto known = std::ranges::find(tallies_, name, &SourceTally::source);
    const bool is_free = known == tallies_.end() || known->writer.source() == writer ||
                         !known->writer.is_held(monotonic_ns, 0);
    if (is_free) return name;
  }
}

bool PoseSources::is_named(const SourceName& source) const noexcept {
  return std::ranges::find(named_, source) != named_.end();
}

// The number of free places that are not reserved for named sources.
std::size_t PoseSources::places_for_others() const noexcept {
  const auto taken = std::ranges::count_if(
      tallies_, [this](const SourceTally& tally) { return !is_named(tally.source); });
  const std::size_t used = named_.size() + static_cast<std::size_t>(taken);
  return used < kMaxSources ? kMaxSources - used : 0;
}

// The source that has been silent for the longest time among those that may be replaced.
SourceTally* PoseSources::free_place(std::int64_t monotonic_ns) {
  SourceTally* longest = nullptr;
  for (SourceTally& tally : tallies_) {
    const std::uint64_t writer = tally.writer.source();
    const bool spare = std::ranges::count(tallies_, writer, writer_of) > 1;
    const std::int64_t silent = monotonic_ns - tally.last_ns;
    if (is_named(tally.source)) continue;
    const bool may_go = writer == 0 || silent >= (spare ? kSourceSilentNs : kPlaceHeldNs);
    if (may_go && (longest == nullptr || tally.last_ns < longest->last_ns)) longest = &tally;
  }
  return longest;
}

void PoseSources::keep(std::span<const std::uint64_t> writers) {
  for (SourceTally& tally : tallies_) {
    if (std::ranges::find(writers, writer_of(tally)) == writers.end()) tally.writer.leave();
  }
}

// The first refused sources are listed by name. All others are counted together, by cause.
Admission PoseSources::refuse(const SourceName& source, SourceRefusal cause, std::size_t poses) {
  Admission refusal{.cause = cause};
  const auto entry_of = [&](const SourceName& name) {
    return std::ranges::find_if(refused_, [&](const RefusedSource& refused) {
      return refused.source == name && refused.cause == cause;
    });
  };
  auto entry = entry_of(source);
  if (entry == refused_.end() && refused_.size() < 2 * kMaxSources) {
    refusal.news = Admission::News::kFirstRefusal;
    entry = refused_.insert(refused_.end(), {.source = source, .cause = cause});
  } else if (entry == refused_.end()) {
    entry = entry_of(SourceName());
    if (entry == refused_.end()) entry = refused_.insert(refused_.end(), {.cause = cause});
  }
  entry->poses += poses;
  return refusal;
}

}  // namespace clearance
