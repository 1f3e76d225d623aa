// A plain reader of gradients, which holds against the times of writing that of two partners never
// two write at once what has one leader.
//
// The oracle is a silence. A leader writes for at most 15 ms after its last notice was due. The
// next one writes only when it has led for 20 ms, from half a period after that notice or the next
// one was due. So between samples of two daemons lie 5 ms and half a period at least, and 5 ms and
// a period unless that notice came late.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/dds/partner_port.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance::test {

class OneLeader {
 public:
  OneLeader(Participant& participant, const Cell& cell)
      : period_ns_(static_cast<std::int64_t>(1e9 / cell.scene.rate_hz)),
        reader_(participant.reader(TopicKind::kGradients, cell.topics.gradients, 8192)) {}

  // Often enough that no more than 8192 samples wait.
  void take() {
    void* pointer = &*sample_;
    dds_sample_info_t info;
    while (dds_take(reader_, &pointer, &info, 1, 1) > 0) {
      if (info.valid_data) written_.push_back({info.source_timestamp, sample_->daemon});
    }
  }
  // The other half of a cut network has a leader, too: what this daemon wrote from that time until
  // this one is not looked at. The times are by dds_time().
  void leave_out(std::uint64_t daemon, std::int64_t from_ns, std::int64_t until_ns) {
    std::erase_if(written_, [=](const Written& one) {
      return one.daemon == daemon && one.at_ns >= from_ns && one.at_ns <= until_ns;
    });
  }

  struct Found {
    std::size_t samples = 0;
    int successions = 0;
    // Lone samples of a process that went on: it had been stopped, or was held up, between the
    // check and the write.
    int old = 0;
    int soon = 0;    // successions as after a late notice
    int faults = 0;  // successions that came too soon
    std::string text = {};
  };
  [[nodiscard]] Found found() {
    take();
    std::ranges::stable_sort(written_, {}, &Written::at_ns);
    Found found{.samples = written_.size()};
    const std::int64_t least_ns = leader_lease_ns(period_ns_) / 4 + period_ns_;
    std::map<std::uint64_t, std::int64_t> last_ns;  // by daemon
    const Written* before = nullptr;
    for (std::size_t i = 0; i < written_.size(); ++i) {
      const Written& one = written_[i];
      const Written* const after = i + 1 < written_.size() ? &written_[i + 1] : nullptr;
      const bool is_other = before != nullptr && one.daemon != before->daemon;
      const bool is_last = after == nullptr || after->daemon != one.daemon;
      const bool is_near = (is_other && one.at_ns - before->at_ns < least_ns) ||
                           (after != nullptr && is_last && after->at_ns - one.at_ns < least_ns);
      const auto [last, is_first] = last_ns.emplace(one.daemon, one.at_ns);
      const bool was_held_up = one.at_ns - std::exchange(last->second, one.at_ns) >
                               leader_lease_ns(period_ns_) * 3 / 4 + period_ns_;
      if (is_near && is_last && was_held_up) {
        const auto apart_ms = [&](const Written* other) {
          return other == nullptr ? kInfinity
                                  : 1e-6 * static_cast<double>(other->at_ns - one.at_ns);
        };
        found.text += fmt::format("{:x} wrote one sample, at {:.1f} and {:.1f} ms of others\n",
                                  one.daemon, apart_ms(before), apart_ms(after));
        ++found.old;
        continue;
      }
      found.successions += is_other ? 1 : 0;
      found.soon += is_other && one.at_ns - before->at_ns < least_ns ? 1 : 0;
      if (is_other && one.at_ns - before->at_ns < least_ns - period_ns_ / 2 && ++found.faults <= 5)
        found.text +=
            fmt::format("{:x} wrote {:.1f} ms after {:x}\n", one.daemon,
                        1e-6 * static_cast<double>(one.at_ns - before->at_ns), before->daemon);
      before = &one;
    }
    return found;
  }

  void check() {
    const Found all = found();
    EXPECT_EQ(all.faults, 0) << all.text << "two wrote at once what has one leader";
    EXPECT_LE(all.soon, all.successions / 4) << all.text << "most notices come in time";
    EXPECT_LE(all.old, 1 + all.successions / 20) << all.text << "such a moment is short";
  }

 private:
  struct Written {
    std::int64_t at_ns;
    std::uint64_t daemon;
  };
  std::int64_t period_ns_;
  dds_entity_t reader_;
  Sample<clearance_msg_Gradients> sample_;
  std::vector<Written> written_;
};

}  // namespace clearance::test
