// Who may be heard: which DDS writer a source name belongs to, and which names have one of the 16
// places. Knows writers by their publication handles and no DDS, so that tests need none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

// What came from one source, since it has its place.
struct SourceTally {
  SourceName source;
  std::uint64_t writer = 0;     // whose name it is
  std::uint64_t batches = 0;    // handed to the tick
  std::uint64_t lost = 0;       // gaps in the sequence numbers, and batches with no slot free
  std::uint64_t cut_poses = 0;  // beyond what a batch of this cell can hold: not used
  std::uint64_t last_sequence = 0;
  std::int64_t last_ns = 0;  // when its last sample was taken, CLOCK_MONOTONIC
  bool warned_of_revision = false;

  // Counts what is missing before this number. A smaller one, or one that is farther ahead than
  // anything is lost, is a source that counts anew.
  void note_sequence(std::uint64_t number) noexcept;
};

// Why the batches of a source are not used.
enum class SourceRefusal : std::uint8_t {
  kTooMany,      // all places are taken
  kOtherWriter,  // the name belongs to another writer
};
[[nodiscard]] const char* name(SourceRefusal cause) noexcept;

struct RefusedSource {
  SourceName source = {};  // empty: all others together
  SourceRefusal cause = SourceRefusal::kTooMany;
  std::uint64_t poses = 0;
};

// What a batch counts for, and what a person should know of it.
struct Admission {
  enum class News : std::uint8_t { kNothing, kNewSource, kTakenOver, kFirstRefusal };
  SourceTally* tally = nullptr;  // null: refused, for `cause`
  SourceRefusal cause = SourceRefusal::kTooMany;
  News news = News::kNothing;
  std::uint64_t former_writer = 0;  // of the name, when taken over or refused for it
  SourceName place_of = {};         // new source: who gave its place up for it; empty: nobody
};

class PoseSources {
 public:
  // A name whose writer has been silent for this long may be taken over by another.
  static constexpr std::int64_t kNameHeldNs = 1'000'000'000;
  // A place goes to another source after this silence; after the shorter one where its writer has
  // more places.
  static constexpr std::int64_t kPlaceHeldNs = 10'000'000'000;
  static constexpr std::int64_t kSparePlaceHeldNs = 1'000'000'000;

  // `named`: the sources that the cell names, whose places nobody else gets.
  explicit PoseSources(std::vector<SourceName> named = {});

  // Who a batch of this name, taken from this writer, counts for. The tally is valid until the next
  // call.
  Admission admit(const SourceName& source, std::uint64_t writer, std::size_t poses,
                  std::int64_t monotonic_ns);
  // Of the writers, only these are still there: names and places of others are free.
  void keep(std::span<const std::uint64_t> writers);

  [[nodiscard]] const std::vector<SourceTally>& tallies() const noexcept { return tallies_; }
  [[nodiscard]] const std::vector<RefusedSource>& refused() const noexcept { return refused_; }
  // What those that have given up their places had counted.
  [[nodiscard]] const SourceTally& departed() const noexcept { return departed_; }

 private:
  [[nodiscard]] bool is_named(const SourceName& source) const noexcept;
  [[nodiscard]] std::size_t places_for_others() const noexcept;
  [[nodiscard]] SourceTally* free_place(std::int64_t monotonic_ns);
  Admission refuse(const SourceName& source, SourceRefusal cause, std::size_t poses);

  std::vector<SourceName> named_;
  std::vector<SourceTally> tallies_;
  std::vector<RefusedSource> refused_;
  SourceTally departed_;
};

}  // namespace clearance
