// Compares the reports of this daemon with those of its partner, cycle by cycle.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "monitor/interface/mutex.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// Any thread. Differences are told in the log, each kind at most once per second, and counted.
class PartnerReports {
 public:
  // A report that this daemon published, or that its partner did.
  void note_own(const clearance_msg_Distances& report) { note(report, false); }
  void note_other(const clearance_msg_Distances& report) { note(report, true); }
  // Notes a report of the partner that does not have the checksum that it states. It counts as
  // different.
  void note_corrupt(const clearance_msg_Distances& report);
  // The partner has published within this time. One that was not heard for a tenth of a second is
  // late or gone. Only one that was not heard for half a second counts as gone for what it then
  // does not have.
  static constexpr std::int64_t kLateAfterNs = 100'000'000, kGoneAfterNs = 500'000'000;
  [[nodiscard]] bool hears_any(std::int64_t within_ns = kLateAfterNs);
  // True: the partner has published once, and since then the two have not agreed, or do so no
  // longer.
  [[nodiscard]] bool disagrees();
  [[nodiscard]] std::string name();  // of the partner that was heard last; empty: none
  // A partner of another name than this has published in the last tenth of a second: a third one is
  // not let in.
  [[nodiscard]] bool hears_another(const std::string& partner);
  // Fills the fields that compare the two; called once per second.
  void fill(clearance_msg_PartnerHealth& out);

 private:
  static constexpr std::size_t kKept = 256;
  struct Kept {
    std::uint64_t cycle = 0, lineage = 0, checksum = 0, state_checksum = 0, inputs_checksum = 0;
    std::int64_t publish_ns = 0;
  };
  using Cycles = std::array<Kept, kKept>;
  enum Kind : std::uint8_t { kAgrees, kOtherInputs, kDifferent, kMissing, kCorrupt, kKinds };

  void note(const clearance_msg_Distances& report, bool is_other);
  void compare(const Kept& own, const Kept& other) REQUIRES(mutex_);
  void look_for_missing(std::uint64_t cycle) REQUIRES(mutex_);
  [[nodiscard]] bool may_tell(Kind kind) REQUIRES(mutex_);

  Mutex mutex_;
  GUARDED_BY(mutex_) Cycles own_{}, other_{};
  GUARDED_BY(mutex_) std::string name_;  // the partner's
  GUARDED_BY(mutex_) std::int64_t heard_ns_ = 0;
  GUARDED_BY(mutex_) std::uint64_t agrees_from_ = 0, compared_ = 0, different_ = 0;
  GUARDED_BY(mutex_) std::uint64_t other_inputs_ = 0, missing_ = 0;
  GUARDED_BY(mutex_) std::vector<std::int64_t> phases_;  // since the last fill()
  GUARDED_BY(mutex_) std::int64_t phase_ns_ = 0;
  GUARDED_BY(mutex_) std::array<std::int64_t, kKinds> told_ns_{};
};

}  // namespace clearance
