// The reader ignores this participant's own writers, so it hears all others of the topic. Samples
// are taken without decoding them: only their writer matters.
#include "monitor/dds/other_daemons.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "monitor/app/log_line.hpp"

namespace clearance {
namespace {

// Cyclone calls this in a thread of its own.
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

// The reader's listener points into this object.
OtherDaemons::~OtherDaemons() { dds_delete(reader_); }

void OtherDaemons::poll() {
  if (changed_.exchange(false)) note_writers();
  while (take_cdr(reader_, taken_) > 0) {
    for (const CdrSample& sample : taken_) {
      if (!has_met(sample.writer())) meet(sample.writer(), true);
      if (std::ranges::find(partners_, sample.writer(), &Partner::writer) == partners_.end())
        ++reports_;
    }
    taken_.clear();
  }
}

void OtherDaemons::note_writers() {
  const std::vector<std::uint64_t> present = writers_of(reader_);
  const std::size_t gone = std::erase_if(met_, [&](dds_instance_handle_t writer) {
    return std::ranges::find(present, writer) == present.end();
  });
  std::erase_if(partners_, [&](const Partner& partner) { return !has_met(partner.writer); });
  if (gone > 0) {
    left_ = true;
    log_line(lines::kOtherWriterLeft, topic_, met_.size());
  }
  for (const std::uint64_t writer : present) {
    if (!has_met(writer)) meet(writer, false);
  }
}

bool OtherDaemons::has_met(dds_instance_handle_t writer) const {
  return std::ranges::find(met_, writer) != met_.end();
}

// There are two partners at most: a third one would ask both for their states again and again. A
// younger twin of a partner ends by itself, and says nothing of who is third.
void OtherDaemons::note_partner(dds_instance_handle_t writer, const DaemonIdentity& partner) {
  met_.push_back(writer);
  partners_.push_back({writer, partner});
  log_line(lines::kPartnerMet, partner.described(), topic_);
  std::set<std::string> older;  // names
  for (const Partner& each : partners_) {
    if (yields_to(own_, each.identity)) older.insert(each.identity.partner);
  }
  if (older.size() < 2) return;
  log_line(lines::kOtherDaemonFirst, partner.described(), topic_);
  yields_ = true;
}

// Ignores a writer that has left in the meantime. An older daemon counts only when it is heard.
void OtherDaemons::meet(dds_instance_handle_t writer, bool heard) {
  const WriterFacts facts = writer_facts(reader_, writer);
  if (!facts.present) return;
  const auto other = from_user_data(facts.user_data);
  if (other && are_partners(own_, *other)) return note_partner(writer, *other);
  const bool first = other && yields_to(own_, *other);
  if (first && !heard) return;
  met_.push_back(writer);
  ++writers_;
  if (first) {
    log_line(lines::kOtherDaemonFirst, other->described(), topic_);
    yields_ = true;
  } else if (other) {
    log_line(lines::kOtherDaemonLater, other->described(), topic_);
  } else {
    log_line(lines::kOtherProgram, facts.guid, topic_);
  }
}

}  // namespace clearance
