#include "monitor/publish/zone_writer.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace clearance {

ZoneWriter::ZoneWriter(dds_entity_t writer, const Scene& scene, std::uint64_t daemon, Write write)
    : writer_(writer),
      scene_(&scene),
      daemon_(daemon),
      write_(std::move(write)),
      written_(scene.zones.size()),
      is_active_(scene.zones.size()),
      log_(scene) {}

// The log has the changes of states, whether they are written or not.
void ZoneWriter::note(const Report& report) {
  for (std::uint32_t zone = 0; zone < report.zones.size(); ++zone) {
    const bool active = report.zones[zone].active;
    if (is_active_[zone] == active) continue;
    is_active_[zone] = active;
    log_.note(zone, report.zones[zone], report.cycle);
  }
}

bool ZoneWriter::is_due(std::uint32_t zone, const WrittenZone& present) const {
  if (!present.active && which_ == Which::kActive) return false;
  return again_ || (active_again_ && present.active) || written_.last(zone) != present;
}

// One that DDS refuses is written with the next report, and so are those behind it: each refusal
// has taken as long as a write may block.
void ZoneWriter::write(const Report& report, const MapPairs& pairs) {
  if (withdraws_) withdraw();
  if (which_ == Which::kNothing) return;
  for (std::uint32_t zone = 0; zone < report.zones.size(); ++zone) {
    const WrittenZone present = WrittenZone::of(report.zones[zone]);
    if (!is_due(zone, present)) continue;
    clearance_msg_ZoneState state{};
    state.daemon = daemon_;
    to_wire(*scene_, report, zone, state);
    pairs.in(state);
    if (!write_(writer_, state)) return written_.forget(zone);
    written_.set(zone, present);
  }
  again_ = active_again_ = false;
}

void ZoneWriter::set(Which which) {
  const Which before = std::exchange(which_, which);
  again_ = again_ || which > before;
  if (which < before) withdraw();
}

// One that was never written, or was refused, may still be there as it was before. DDS refuses
// where a reader does not keep up: then it is tried again with the next report.
void ZoneWriter::withdraw() {
  withdraws_ = false;
  if (which_ == Which::kAll) return;
  for (std::uint32_t zone = 0; zone < scene_->zones.size(); ++zone) {
    if (which_ == Which::kActive && written_.is_active(zone)) continue;
    clearance_msg_ZoneState state{};
    state.zone = zone;
    withdraws_ = dds_unregister_instance(writer_, &state) == DDS_RETCODE_TIMEOUT || withdraws_;
    written_.forget(zone);
  }
}

void ZoneWriter::change(const Scene& scene, bool disposes) {
  WrittenZones written(scene.zones.size());
  std::vector<bool> is_active(scene.zones.size());
  for (std::uint32_t zone = 0; zone < scene_->zones.size(); ++zone) {
    const auto same = std::ranges::find(scene.zones, scene_->zones[zone].name, &Zone::name);
    if (same != scene.zones.end()) {
      const auto number = static_cast<std::uint32_t>(same - scene.zones.begin());
      is_active[number] = is_active_[zone];
      if (const auto& last = written_.last(zone)) written.set(number, *last);
    }
    clearance_msg_ZoneState gone{};
    gone.zone = zone;
    if (zone < scene.zones.size()) continue;
    disposes ? dds_dispose(writer_, &gone) : dds_unregister_instance(writer_, &gone);
  }
  scene_ = &scene;
  written_ = std::move(written);
  is_active_ = std::move(is_active);
  log_.change(scene);
  again_ = true;
}

}  // namespace clearance
