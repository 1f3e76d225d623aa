#include "monitor/participant/lapsed_writers.hpp"

namespace clearance {

LapsedWriters::LapsedWriters() : listener_(dds_create_listener(nullptr)) {
  dds_lset_liveliness_changed_arg(listener_.get(), note, this, true);
}

// Cyclone calls this in a thread of its own, once for each change of a writer: one that lapses, one
// that is heard again, or one that leaves.
void LapsedWriters::note(dds_entity_t, dds_liveliness_changed_status_t status, void* lapsed) {
  auto& self = *static_cast<LapsedWriters*>(lapsed);
  const Lock lock(self.mutex_);
  if (status.not_alive_count_change > 0) {
    self.lapsed_.insert(status.last_publication_handle);
  } else {
    self.lapsed_.erase(status.last_publication_handle);
  }
}

void LapsedWriters::remove_from(std::vector<std::uint64_t>& writers) const {
  const Lock lock(mutex_);
  std::erase_if(writers,
                [&](std::uint64_t writer) REQUIRES(mutex_) { return lapsed_.contains(writer); });
}

}  // namespace clearance
