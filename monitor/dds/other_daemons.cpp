// A reader that ignores this participant's own writers hears all others of the topic. Samples are
// taken as bytes: only who wrote them matters.
#include "monitor/dds/other_daemons.hpp"

#include <dds/ddsi/ddsi_serdata.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace clearance {
namespace {

// Called in a thread of Cyclone's.
void note_change(dds_entity_t, const dds_subscription_matched_status_t, void* changed) {
  static_cast<std::atomic<bool>*>(changed)->store(true);
}

dds_entity_t make_reader(Participant& participant, const std::string& topic,
                         std::atomic<bool>& changed) {
  dds_listener_t* listener = dds_create_listener(nullptr);
  dds_lset_subscription_matched_arg(listener, note_change, &changed, true);
  const dds_entity_t reader = participant.reader_of_others(topic, listener);
  dds_delete_listener(listener);
  return reader;
}

}  // namespace

OtherDaemons::OtherDaemons(Participant& participant, const std::string& topic, DaemonIdentity own)
    : own_(std::move(own)), topic_(topic), reader_(make_reader(participant, topic, changed_)) {}

// The listener points into this.
OtherDaemons::~OtherDaemons() { dds_delete(reader_); }

void OtherDaemons::look() {
  if (changed_.exchange(false)) note_writers();
  ddsi_serdata* sample = nullptr;
  dds_sample_info_t info;
  while (dds_takecdr(reader_, &sample, 1, &info, DDS_ANY_STATE) == 1) {
    ddsi_serdata_unref(sample);
    if (!info.valid_data) continue;
    ++reports_;
    if (!has_met(info.publication_handle)) meet(info.publication_handle, true);
  }
}

void OtherDaemons::note_writers() {
  const std::vector<std::uint64_t> present = writers_of(reader_);
  const std::size_t gone = std::erase_if(met_, [&](dds_instance_handle_t writer) {
    return std::ranges::find(present, writer) == present.end();
  });
  if (gone > 0) {
    left_ = true;
    spdlog::info("another writer of {} has left, {} are there", topic_, met_.size());
  }
  for (const std::uint64_t writer : present) {
    if (!has_met(writer)) meet(writer, false);
  }
}

bool OtherDaemons::has_met(dds_instance_handle_t writer) const {
  return std::ranges::find(met_, writer) != met_.end();
}

// A writer that has left in the meantime is not met, nor is a daemon that was here first, before it
// is heard.
void OtherDaemons::meet(dds_instance_handle_t writer, bool heard) {
  const WriterFacts facts = writer_facts(reader_, writer);
  if (!facts.present) return;
  const auto other = from_user_data(facts.user_data);
  const bool first = other && gives_way(own_, *other);
  if (first && !heard) return;
  met_.push_back(writer);
  ++writers_;
  if (first) {
    spdlog::error("another daemon, {}, publishes on {} and was here first: this one ends",
                  other->described(), topic_);
    give_way_ = true;
  } else if (other) {
    spdlog::warn(
        "another daemon, {}, publishes on {} as well; it started later and has to give way",
        other->described(), topic_);
  } else {
    spdlog::warn(
        "a program that is no daemon (writer {}) publishes on {} as well: clients see both",
        facts.guid, topic_);
  }
}

}  // namespace clearance
