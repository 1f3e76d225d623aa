// Frames of sensors between partners, on DDS. The leader sends all that a frame is built of, and
// the other daemon builds the same frame of it. So both have it before a tick is shown it.
#pragma once

#include <cstdint>
#include <functional>

#include "config/cell/topics.hpp"
#include "monitor/dds/daemon_identity.hpp"
#include "monitor/loop/tick_partner.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/sensors/built_frames.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// For the thread that builds frames.
class PartnerFrames {
 public:
  // Everything given must outlive this.
  PartnerFrames(Participant& participant, const Topics& topics, const DaemonIdentity& identity,
                const TickPartner& ticks);

  [[nodiscard]] dds_entity_t reader() const noexcept { return reader_; }

  // A frame that this daemon builds of what it has heard of sensors itself.
  void send(const BuiltFrame& frame, std::uint64_t content);
  // The frame of this content of the partner was built.
  void answer(std::uint32_t sensor, std::uint64_t content);

  using Answered = std::function<void(std::uint32_t sensor, std::uint64_t content)>;
  using Sent = std::function<void(BuiltFrame frame, std::uint64_t content)>;
  // Takes what has come. `now_ns`: CLOCK_MONOTONIC.
  void take(std::int64_t now_ns, const Answered& answered, const Sent& sent);

  [[nodiscard]] bool leads() const noexcept {
    return ticks_.standing() == PartnerStanding::kLeading;
  }
  // A daemon that does not follow has frames of its own while none of the partner come.
  [[nodiscard]] bool builds_its_own(std::int64_t now_ns) const noexcept;

 private:
  void write(Sample<clearance_msg_PartnerFrame>& sample, std::uint32_t sensor,
             std::uint64_t content);

  const DaemonIdentity& identity_;
  const TickPartner& ticks_;
  dds_entity_t writer_, reader_;
  std::int64_t heard_ns_ = 0;  // the partner's last frame; 0: none
  Sample<clearance_msg_PartnerFrame> heard_;
};

}  // namespace clearance
