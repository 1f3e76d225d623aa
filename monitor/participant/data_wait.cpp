#include <vector>

#include "monitor/participant/participant.hpp"

namespace clearance {

// A guard condition beside the readers' conditions lets another thread end the wait.
DataWait::DataWait(const Participant& participant, const std::vector<dds_entity_t>& readers)
    : waitset_(check_dds(dds_create_waitset(participant.handle()), "making a waitset")),
      guard_(
          check_dds(dds_create_guardcondition(participant.handle()), "making a guard condition")) {
  check_dds(dds_waitset_attach(waitset_, guard_, 0), "attaching to a waitset");
  for (const dds_entity_t reader : readers) add(reader);
}

// If the participant has been deleted, both are deleted already.
DataWait::~DataWait() {
  dds_delete(waitset_);
  dds_delete(guard_);
}

void DataWait::add(dds_entity_t reader) {
  const dds_entity_t condition =
      check_dds(dds_create_readcondition(reader, DDS_ANY_STATE), "making a read condition");
  check_dds(dds_waitset_attach(waitset_, condition, reader), "attaching to a waitset");
}

// The guard is reset here, so one wake() ends one wait.
bool DataWait::wait(std::int64_t timeout_ns) {
  const dds_return_t triggered = dds_waitset_wait(waitset_, nullptr, 0, timeout_ns);
  bool woken = false;
  dds_take_guardcondition(guard_, &woken);
  return triggered > 0 && !woken;
}

void DataWait::wake() noexcept { dds_set_guardcondition(guard_, true); }

}  // namespace clearance
