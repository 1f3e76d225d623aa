// Publishes a joined cell on the topics of the cell, as a daemon of the whole cell would, and once
// more as messages of ROS 2 if the cell asks for them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/client/shared_cell.hpp"
#include "monitor/dds/daemon_identity.hpp"
#include "monitor/dds/other_daemons.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/publish/ros_messages.hpp"
#include "monitor/wire/written_zones.hpp"
#include "tools/merge/zone_check.hpp"

namespace clearance::merge {

class JoinedWriter {
 public:
  // Gets the health that was written last.
  using OnHealth = std::function<void(Sample<clearance_msg_Health>)>;

  // `daemon` is the number in all messages. The participant and the cell outlive this. Throws
  // DdsError.
  JoinedWriter(Participant& participant, const Cell& cell, std::uint64_t daemon,
               OnHealth on_health);

  // Writes the report at hand, and what has changed with it: catalogue, separations, zones. Health
  // goes out once per second.
  void write(client::SharedCell& whole);
  // Another program that started first publishes this cell.
  [[nodiscard]] bool yields() const noexcept { return others_.yields(); }
  // "12 reports, 0 of them not whole, ..."
  [[nodiscard]] std::string summary(const client::SharedCell& whole) const;

 private:
  [[nodiscard]] bool write_catalogue(const clearance_msg_Catalogue& catalogue);
  void write_zones(const client::SharedCell& whole, bool again);
  // Seals a message, and writes it. False: DDS has not taken it.
  template <class Message>
  bool send(TopicKind kind, dds_entity_t writer, Message message);
  template <class Message>
  void send_tick(TopicKind kind, dds_entity_t writer, Message message);
  bool put(TopicKind kind, dds_entity_t writer, const void* sample);

  Participant& participant_;
  DaemonIdentity identity_;
  Topics topics_;
  const OnHealth on_health_;
  std::int64_t lease_ns_, period_ns_;
  dds_entity_t distances_, catalogue_, zones_, health_;
  dds_entity_t separation_ = 0, gradients_ = 0;  // 0: no share has had any yet
  RosMessages messages_;
  OtherDaemons others_;
  std::uint64_t revision_ = 0;                    // of the catalogue that was written; 0: none
  std::map<std::uint32_t, WrittenZone> written_;  // by zone
  std::int64_t health_ns_ = 0;
  std::uint64_t reports_ = 0, not_whole_ = 0, failed_ = 0;
  ZoneCheck zone_check_;
  // Times of the joined reports, us.
  struct Delays {
    std::vector<double> merging;    // from the oldest share's report to that of the whole
    std::vector<double> published;  // from the oldest pose in use to the oldest share's report
    std::vector<double> joined;     // from the same pose to the report of the whole
  };
  Delays delays_us_;
};

}  // namespace clearance::merge
