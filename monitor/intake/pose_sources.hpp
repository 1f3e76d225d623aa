// Admission of sources: the DDS writer that each source name belongs to, and the sources that have
// one of the 16 places. Writers are known by their publication handles, so tests need no DDS.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "monitor/inputs/input_owner.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

// The writer to which a name belongs; 0: it has left.
using NameOwner = Owner<std::uint64_t, 0>;

// Counts of one source since it was given one of the places.
struct SourceTally {
  SourceName source;
  NameOwner writer = {};
  std::uint64_t batches = 0;    // handed to the tick
  std::uint64_t lost = 0;       // gaps in the sequence numbers, and batches with no slot free
  std::uint64_t cut_poses = 0;  // poses above the largest size of a batch: not used
  std::uint64_t last_sequence = 0;
  std::int64_t last_ns = 0;  // when its last sample was taken, CLOCK_MONOTONIC
  bool warned_of_revision = false;

  // Counts the batches that are missing before this number. A source has restarted its numbers if
  // this one is smaller, or farther ahead than any plausible loss. 0 stands for no number.
  void note_sequence(std::uint64_t number) noexcept;
};

// Returns the source name of the n-th writer that uses a name: NAME, "NAME#2" and so on.
[[nodiscard]] SourceName name_of_writer(std::string_view name, std::size_t number);

// Why the batches of a source are not used.
enum class SourceRefusal : std::uint8_t {
  kTooMany,      // all places are taken
  kOtherWriter,  // the name belongs to another writer
  kNoName,       // an empty name, which stands for no source everywhere else
};
[[nodiscard]] const char* name(SourceRefusal cause) noexcept;

struct RefusedSource {
  SourceName source = {};  // empty: the sum of all others, or those without a name
  SourceRefusal cause = SourceRefusal::kTooMany;
  std::uint64_t poses = 0;
};

// The result of an admission: the tally that a batch counts for, and the news for a person.
struct Admission {
  enum class News : std::uint8_t { kNothing, kNewSource, kTakenOver, kFirstRefusal };
  SourceTally* tally = nullptr;  // null: refused, for `cause`
  SourceRefusal cause = SourceRefusal::kTooMany;
  News news = News::kNothing;
  std::uint64_t former_writer = 0;  // of the name, when it is taken over or refused
  SourceName place_of = {};         // the source that gave up its place to a new one; empty: none
};

class PoseSources {
 public:
  // Another source may get a place after this silence; after kSourceSilentNs, if the writer of the
  // silent source has more places.
  static constexpr std::int64_t kPlaceHeldNs = 10'000'000'000;

  // `named` are the sources that the cell names. Their places are reserved.
  explicit PoseSources(std::vector<SourceName> named = {});

  // Admits or refuses a batch with this source name from this writer. The tally is valid until the
  // next call.
  Admission admit(const SourceName& source, std::uint64_t writer, std::size_t poses,
                  std::int64_t monotonic_ns);
  // The cell has changed and names these sources now.
  void change_named(std::vector<SourceName> named) { named_ = std::move(named); }
  // Returns the first of NAME, NAME#2, NAME#3 and so on that belongs to no other writer. At
  // most kMaxSources names are in use at a time.
  [[nodiscard]] SourceName name_for(const SourceName& source, std::uint64_t writer,
                                    std::int64_t monotonic_ns) const;
  [[nodiscard]] bool is_named(const SourceName& source) const noexcept;
  // `writers` are those that still exist. The names and places of all others become free.
  void keep(std::span<const std::uint64_t> writers);

  [[nodiscard]] const std::vector<SourceTally>& tallies() const noexcept { return tallies_; }
  [[nodiscard]] const std::vector<RefusedSource>& refused() const noexcept { return refused_; }
  // The sum of the counts of sources that have given up their places.
  [[nodiscard]] const SourceTally& departed() const noexcept { return departed_; }

 private:
  [[nodiscard]] std::size_t places_for_others() const noexcept;
  [[nodiscard]] SourceTally* free_place(std::int64_t monotonic_ns);
  Admission refuse(const SourceName& source, SourceRefusal cause, std::size_t poses);

  std::vector<SourceName> named_;
  std::vector<SourceTally> tallies_;
  std::vector<RefusedSource> refused_;
  SourceTally departed_;
};

}  // namespace clearance
