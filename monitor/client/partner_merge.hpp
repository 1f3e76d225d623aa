// Merges the reports of two partners (monitor/partners/README.md) into one stream.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "monitor/wire/dds_sample.hpp"

namespace clearance::client {

enum class PartnerState : std::uint8_t {
  kAlone = 0,    // there is one daemon, or the second one was not heard yet
  kAgrees = 1,   // the partner reported the same inputs and the same bits
  kMissing = 2,  // the partner's report of the cycle before has not come
  // The partner's report of the cycle rests on other inputs: both are true, and need not be alike.
  kOtherInputs = 3,
  // The partner's report has the same inputs and other bits: one of the two machines is faulty.
  kDifferent = 4,
  // A report does not have the checksum that it states. It was not handed out.
  kCorrupt = 5,
};
[[nodiscard]] const char* name(PartnerState state) noexcept;

// The state of the two partners when a report is handed out.
struct PartnerCheck {
  PartnerState state = PartnerState::kAlone;
  std::uint64_t cycle = 0;   // of the report that it is about; 0: kAlone
  std::string partner = {};  // who published that; of kMissing: who did not
};

// The first good report of a cycle is handed out, and the other one is compared with it. A partner
// that ticks apart, whose cycles may have other numbers, takes the place of one that has fallen
// silent.
class PartnerMerge {
 public:
  // Takes a report of any partner, in the order of arrival. Returns true if it is to be handed out;
  // check() is then about the reports before it.
  [[nodiscard]] bool take(const clearance_msg_Distances& report);
  [[nodiscard]] const PartnerCheck& check() const noexcept { return check_; }
  // The last report that was taken had the checksums that it states.
  [[nodiscard]] bool was_good() const noexcept { return was_good_; }

 private:
  static constexpr std::size_t kSeen = 64;
  struct Seen {
    std::uint64_t cycle = 0, daemon = 0, lineage = 0, state_checksum = 0;
    bool is_compared = false;
  };
  [[nodiscard]] bool is_next(const clearance_msg_Distances& report) const noexcept;
  void compare(const clearance_msg_Distances& report);
  void note(PartnerState state, const clearance_msg_Distances& report);
  void note_names(const clearance_msg_Distances& report);

  std::array<Seen, kSeen> seen_{};  // those that were handed out, by cycle
  std::uint64_t cycle_ = 0, lineage_ = 0;
  std::int64_t now_ns_ = 0, step_ns_ = 0;  // of the last one, and since the one before it
  std::array<std::string, 2> names_;       // of both partners, the one heard last first
  PartnerCheck check_, found_;             // the latter: since the last one was handed out
  bool was_good_ = false;
};

}  // namespace clearance::client
