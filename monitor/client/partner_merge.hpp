// Merges the reports of two partners (monitor/loop/PARTNERS.md) into one stream.
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
  // A report does not have the CRC that it states. It was not handed out.
  kCorrupt = 5,
};
[[nodiscard]] const char* name(PartnerState state) noexcept;

// The state of the two partners when a report is handed out.
struct PartnerCheck {
  PartnerState state = PartnerState::kAlone;
  std::uint64_t cycle = 0;   // of the report that it is about; 0: kAlone
  std::string partner = {};  // who published that; of kMissing: who did not
};

// The worse one of two, or the later one of two that are alike: for a program that looks at some
// reports only.
[[nodiscard]] inline const PartnerCheck& worse(const PartnerCheck& before,
                                               const PartnerCheck& after) noexcept {
  return before.state > after.state ? before : after;
}

// The first good report of a cycle is handed out, and the other one is compared with it. A partner
// that ticks apart, whose cycles may have other numbers, takes the place of one that has fallen
// silent. The stream has one scene at a time. It changes when a daemon of the stream changes its
// scene, or when the daemons that have it have fallen silent.
class PartnerMerge {
 public:
  // Takes a report of any partner, in the order of arrival. `heard_ns` is when, by a clock that is
  // never set. `is_sound`: it has the CRC that it states. Returns true if it is to be handed out;
  // check() is then about the reports before it.
  [[nodiscard]] bool take(const clearance_msg_Distances& report, std::int64_t heard_ns,
                          bool is_sound);
  [[nodiscard]] const PartnerCheck& check() const noexcept { return check_; }
  // The daemons of both partners, and when their last good report was heard, whether it was handed
  // out or not. `daemon` 0: none.
  struct Sender {
    std::string partner;
    std::uint64_t daemon = 0;
    std::int64_t heard_ns = 0;
    std::uint64_t revision = 0;  // of the scene of its last report, or of that handed out
  };
  [[nodiscard]] const std::array<Sender, 2>& senders() const noexcept { return senders_; }

 private:
  static constexpr std::size_t kSeen = 64;
  struct Seen {
    std::uint64_t cycle = 0, daemon = 0, lineage = 0;
    std::uint64_t checksum = 0, state_checksum = 0, inputs_checksum = 0;
    bool is_compared = false;
  };
  [[nodiscard]] bool is_next(const clearance_msg_Distances& report,
                             std::int64_t heard_ns) const noexcept;
  [[nodiscard]] bool is_silent(std::int64_t heard_ns, std::int64_t now_ns) const noexcept;
  [[nodiscard]] bool changes_scene(const clearance_msg_Distances& report) const noexcept;
  [[nodiscard]] bool is_of_scene(const clearance_msg_Distances& report,
                                 std::int64_t heard_ns) const noexcept;
  [[nodiscard]] bool contradicts(const clearance_msg_Distances& report) const noexcept;
  void compare(const clearance_msg_Distances& report);
  void note(PartnerState state, const clearance_msg_Distances& report);
  void note_sender(const clearance_msg_Distances& report, std::int64_t heard_ns,
                   bool is_handed_out);

  std::array<Seen, kSeen> seen_{};  // those that were handed out, by cycle
  std::uint64_t cycle_ = 0, lineage_ = 0, revision_ = 0;
  std::int64_t now_ns_ = 0, period_ns_ = 0;  // of the last one, which states the period
  std::int64_t handed_out_ns_ = 0;           // when the last one was heard
  std::array<Sender, 2> senders_;            // the one heard last first
  PartnerCheck check_, found_;               // the latter: since the last one was handed out
};

}  // namespace clearance::client
