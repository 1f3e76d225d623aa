// Writes zones on change, and remembers what readers that come later get.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/publish/zone_log.hpp"
#include "monitor/wire/convert.hpp"
#include "monitor/wire/written_zones.hpp"

namespace clearance {

// The thread that publishes.
class ZoneWriter {
 public:
  // A reader keeps one state of a zone, that of the last writer. While the partner's zones may be
  // others, an inactive one of this daemon must not take the place of the partner's active one,
  // whereas one that is active in vain is written again when this daemon follows. Ids of a scene
  // that the partner does not have could mean others of its zones: then nothing is written.
  enum class Which : std::uint8_t { kNothing, kActive, kAll };
  // Seals the state. Returns false if DDS has not taken it.
  using Write = std::function<bool(dds_entity_t writer, clearance_msg_ZoneState&)>;

  // `scene` must outlive this, or its use until the next change().
  ZoneWriter(dds_entity_t writer, const Scene& scene, std::uint64_t daemon, Write write);

  // A report comes, whether it is published or not.
  void note(const Report& report);
  // Writes those of the last report noted that have changed, or are due again. `pairs` maps to the
  // ids of the whole cell.
  void write(const Report& report, const MapPairs& pairs);
  // Takes back what is not to be written any more, so that a reader that comes later does not get
  // it. Readers that have it keep it. What is to be written from now on is written again.
  void set(Which which);
  [[nodiscard]] Which which() const noexcept { return which_; }
  // Another daemon may have written them.
  void write_again() noexcept { again_ = true; }
  void write_active_again() noexcept { active_again_ = true; }
  // Zones of the same name are as they were, with other ids; all are written again. Ids that are
  // gone are disposed, or only taken back if they may be those of the partner.
  void change(const Scene& scene, bool disposes);

  // In the last report.
  [[nodiscard]] bool is_active(std::uint32_t zone) const { return is_active_[zone]; }
  void end_second() { log_.end_second(); }

 private:
  [[nodiscard]] bool is_due(std::uint32_t zone, const WrittenZone& present) const;
  void withdraw();

  dds_entity_t writer_;
  const Scene* scene_;
  std::uint64_t daemon_;
  Write write_;
  WrittenZones written_;
  std::vector<bool> is_active_;
  ZoneLog log_;
  Which which_ = Which::kAll;
  bool again_ = false, active_again_ = false, withdraws_ = false;
};

}  // namespace clearance
