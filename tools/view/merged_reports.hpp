// Chooses the reports that the page shows from those of several daemons. Partners
// (monitor/loop) become one stream; those of other daemons are all shown.
#pragma once

#include <cstdint>
#include <string>

#include "monitor/client/partner_merge.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance::view {

class MergedReports {
 public:
  // Take a message of any daemon, in the order of arrival; CLOCK_MONOTONIC. True: it is shown.
  // `is_sound`: it has the CRC that it states.
  [[nodiscard]] bool take(const clearance_msg_Distances& report, std::int64_t steady_ns,
                          bool is_sound);
  // The health of the leading partner is shown, so that figures do not alternate.
  [[nodiscard]] bool take(const clearance_msg_Health& health, std::int64_t steady_ns);
  // Reports may have been lost here: no partner is missing because of that.
  void note_loss(std::int64_t steady_ns) noexcept { lost_ns_ = steady_ns; }

  // All daemons that were heard in the last second are partners.
  [[nodiscard]] bool are_partners(std::int64_t steady_ns) const noexcept;
  // Says what is wrong among the partners, in the words of clearance-watch.
  struct Trouble {
    int level = 0;  // of the protocol: 1 warning, 2 error
    std::string text;
  };
  // Empty: they agree, or there are none.
  [[nodiscard]] Trouble trouble(std::int64_t steady_ns) const;

 private:
  client::PartnerMerge merge_;
  client::PartnerCheck check_;   // the last one that was not good
  bool have_met_ = false;        // two partners were heard
  std::int64_t partner_ns_ = 0;  // the last report of a partner; 0: none
  std::int64_t single_ns_ = 0;   // the last report of a daemon that is none
  std::int64_t check_ns_ = 0, lost_ns_ = 0, leader_ns_ = 0;
};

}  // namespace clearance::view
