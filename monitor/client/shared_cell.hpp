// A client of a cell in shares: reads every share, merges partners of a share, and joins all to the
// report, the zones and the health of the whole cell.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "monitor/client/client.hpp"
#include "monitor/client/share_merge.hpp"

namespace clearance::client {

class ShareNames;

struct SharedCellOptions {
  // A share whose last report is older is left out, and what hangs on it is unknown. It has to be
  // longer than the time that partners take to go on without each other: two periods. If not set,
  // it is three periods of the cell, and at least 20 ms.
  std::optional<std::chrono::nanoseconds> late_after = {};
  std::chrono::nanoseconds old_after = std::chrono::milliseconds(100);  // as StreamOptions'
  bool gradients = false;  // they are read and joined, too
  // The names of the shares. If empty, they are those of the first share that is met.
  std::vector<std::string> names = {};
};

// The state of a share in the present report.
struct ShareCheck {
  std::string name;
  ShareState state = ShareState::kMissing;
  std::uint64_t daemon = 0, cycle = 0, scene_revision = 0;  // of its last report; 0: none
  std::int64_t age_ns = -1;                                 // since it was published; -1: none
  // The worst partner state of the reports since the previous call of next() or newest().
  PartnerCheck partner = {};
};

class SharedCell {
 public:
  // The topics of the connection are those of the cell; each share has its own (topics_of_share).
  explicit SharedCell(Connection& connection, SharedCellOptions options = {});
  ~SharedCell();
  SharedCell(const SharedCell&) = delete;
  SharedCell& operator=(const SharedCell&) = delete;

  // Waits up to `timeout` for the next report of the whole cell. There is one each time that every
  // share has reported again, or that one has reported twice. No report of a share is left out,
  // unless the others still have another scene. If no share reports any longer, one that knows
  // nothing follows after `late_after`, and again. Returns false when none came.
  bool next(std::chrono::nanoseconds timeout = {});
  // Does the same with the newest one.
  bool newest(std::chrono::nanoseconds timeout = {});

  // The last report. `cycle` counts those of this object from 1; `daemon` is its random number.
  [[nodiscard]] const clearance_msg_Distances& operator*() const noexcept { return *message_; }
  [[nodiscard]] const clearance_msg_Distances* operator->() const noexcept { return &*message_; }
  [[nodiscard]] const ReportCheck& check() const noexcept { return check_; }
  // The shares in the order of the cell, as they are in the last report.
  [[nodiscard]] const std::vector<ShareCheck>& shares() const noexcept { return checks_; }
  [[nodiscard]] bool is_whole() const noexcept;
  // Judgement of all shares, as Stream has it of one; kShare if one is not whole.
  [[nodiscard]] bool fail_safe() const noexcept { return reason() != ReportError::kGood; }
  [[nodiscard]] ReportError reason() const noexcept;
  void acknowledge() noexcept;
  // "the share 'left' is missing, the share 'right' is late"; empty if it is whole.
  [[nodiscard]] std::string what_is_missing() const;

  // The state of every zone, as of the last report, by its id.
  [[nodiscard]] const std::map<std::uint32_t, clearance_msg_ZoneState>& zones() const noexcept {
    return zones_;
  }
  // Separations of the report at hand; null if the cell has none, or is not known yet.
  [[nodiscard]] const clearance_msg_Separation* separation() const noexcept {
    return map_.separated().empty() && map_.stopping().empty() ? nullptr : &*separation_;
  }
  // Gradients of the report at hand, if they are asked for; null: no share has any. A pair of a
  // share that is not whole is not in them.
  [[nodiscard]] const clearance_msg_Gradients* gradients() const noexcept {
    return has_gradients_ ? &*gradients_ : nullptr;
  }
  // The catalogue of the report's scene; null before the first report. Its `share` is that of one
  // daemon.
  [[nodiscard]] const clearance_msg_Catalogue* catalogue() const noexcept;
  // The health of all shares, as last told by each, with `shares`.
  [[nodiscard]] Sample<clearance_msg_Health> health();

  // Reports of shares that did not come, by their cycles, since the beginning.
  [[nodiscard]] std::uint64_t missed() const noexcept;
  [[nodiscard]] std::uint64_t daemon() const noexcept { return daemon_; }

 private:
  struct ShareStreams;

  [[nodiscard]] const clearance_msg_Catalogue* catalogue_of(std::uint64_t revision) const noexcept;
  void look_for_names();
  void open(const std::vector<std::string>& names);
  void begin_call();
  bool wait_for_next(std::chrono::nanoseconds timeout);
  void take();
  // No joined report has been made, and either no scene is known, or a share that may still be
  // met has not been heard.
  [[nodiscard]] bool waits_for_first() const;
  [[nodiscard]] bool is_due(std::int64_t now_ns) const;
  // Returns true if the share's last report is not late.
  [[nodiscard]] bool is_here(const ShareStreams& share) const;
  [[nodiscard]] std::uint64_t scene_of_most() const;
  [[nodiscard]] std::uint64_t division_of_most(std::uint64_t revision) const;
  [[nodiscard]] bool can_stay(std::uint64_t next) const;
  [[nodiscard]] bool follow_revision();
  void set_late(std::int64_t late_ns);
  // The pairs of its report are those that the map gives to it.
  [[nodiscard]] bool is_divided_alike(std::size_t share) const;
  void judge(std::int64_t now_ns);
  // False: the shares are others than those that were read, and nothing is joined.
  [[nodiscard]] bool join(std::int64_t now_ns);
  void join_zones();
  // Writes who made a message beside the report.
  template <class Message>
  void sign(Message& message) const;

  Connection& connection_;
  SharedCellOptions options_;
  std::int64_t late_ns_;  // a report that is older is late
  std::uint64_t daemon_;
  std::unique_ptr<ShareNames> discovery_;  // null: the names are known
  std::vector<std::unique_ptr<ShareStreams>> shares_;
  std::unique_ptr<DataWait> wait_;
  ShareMap map_;
  std::vector<ShareCheck> checks_;
  Sample<clearance_msg_Distances> message_;
  Sample<clearance_msg_Separation> separation_;
  Sample<clearance_msg_Gradients> gradients_;
  bool has_gradients_ = false;
  std::map<std::uint32_t, clearance_msg_ZoneState> zones_;
  ReportChecker checker_;
  ReportCheck check_;
  std::int64_t joined_ns_ = 0;                  // when the last report was made, by now_ns()
  std::int64_t opened_at_ = 0, joined_at_ = 0;  // by monotonic_ns()
};

}  // namespace clearance::client
