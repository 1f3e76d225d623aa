// The writers of a reader that still match it although their leases have ended: their processes
// were killed or hang, or cannot be reached.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>
#include <set>
#include <vector>

#include "monitor/interface/mutex.hpp"

namespace clearance {

class LapsedWriters {
 public:
  LapsedWriters();
  LapsedWriters(const LapsedWriters&) = delete;
  LapsedWriters& operator=(const LapsedWriters&) = delete;

  // The listener of the reader. The reader must be deleted before this.
  [[nodiscard]] const dds_listener_t* listener() const noexcept { return listener_.get(); }
  // Removes them from a list of publication handles. Any thread.
  void remove_from(std::vector<std::uint64_t>& writers) const;

 private:
  struct Delete {
    void operator()(dds_listener_t* listener) const noexcept { dds_delete_listener(listener); }
  };
  static void note(dds_entity_t reader, dds_liveliness_changed_status_t status, void* lapsed);

  mutable Mutex mutex_;
  GUARDED_BY(mutex_) std::set<std::uint64_t> lapsed_;
  std::unique_ptr<dds_listener_t, Delete> listener_;
};

}  // namespace clearance
