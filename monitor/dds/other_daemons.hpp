// Is another daemon publishing the same cell? Listens on this daemon's own topic for reports that
// it did not write.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "monitor/dds/daemon_identity.hpp"
#include "monitor/participant/participant.hpp"

namespace clearance {

// Of two that publish, the one that started later gives way, with the first report that it hears of
// the other. A writer that is merely there gets nobody out of the way: its daemon may be dead,
// stopped or hung. One thread calls look() and have_just_left(); the rest any.
class OtherDaemons {
 public:
  // `own` publishes on the distances topic of this name through this participant, which is not
  // listened to.
  OtherDaemons(Participant& participant, const std::string& topic, DaemonIdentity own);
  ~OtherDaemons();
  OtherDaemons(const OtherDaemons&) = delete;
  OtherDaemons& operator=(const OtherDaemons&) = delete;

  // What has come since the last call. Costs 0.2 us when nothing has; no system call.
  void look();
  // True once after others have left: latched topics then hold what they wrote last.
  [[nodiscard]] bool have_just_left() noexcept { return std::exchange(left_, false); }

  // Another daemon was here first: nothing more may be published.
  [[nodiscard]] bool give_way() const noexcept { return give_way_.load(); }
  // Reports of others that were heard since the start, at most one a look.
  [[nodiscard]] std::uint64_t reports() const noexcept { return reports_.load(); }
  // Other writers that were met since the start, whether or not a report of theirs was heard.
  [[nodiscard]] std::uint64_t writers() const noexcept { return writers_.load(); }

 private:
  void note_writers();
  void meet(dds_instance_handle_t writer, bool heard);
  [[nodiscard]] bool has_met(dds_instance_handle_t writer) const;

  DaemonIdentity own_;
  std::string topic_;
  std::atomic<bool> changed_{false};  // writers have come or left
  dds_entity_t reader_;
  std::vector<dds_instance_handle_t> met_;  // of those that are there
  bool left_ = false;
  std::atomic<std::uint64_t> reports_{0}, writers_{0};
  std::atomic<bool> give_way_{false};
};

}  // namespace clearance
