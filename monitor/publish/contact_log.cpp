#include "monitor/publish/contact_log.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "monitor/app/log_line.hpp"
#include "monitor/interface/contact_text.hpp"
#include "monitor/interface/pair_name.hpp"

namespace clearance {
namespace {

void log_contact(const Scene& scene, const ContactReport& contact) {
  const std::string pair = pair_name(scene, contact.pair);
  const std::string text = contact_text(scene.contacts[contact.contact], contact);
  switch (contact.status) {
    case ContactStatus::kAllowed:
      return log_line(lines::kContactAllowed, pair, text);
    case ContactStatus::kTooDeep:
      return log_line(lines::kContactTooDeep, pair, text);
    case ContactStatus::kEnded:
      return log_line(lines::kContactEnded, pair, text);
    case ContactStatus::kTooLate:
      return log_line(lines::kContactTooLate, pair, text);
    case ContactStatus::kUnknown:
    case ContactStatus::kAbsent:
      return;
  }
}

}  // namespace

void ContactLog::change(const Scene& scene) {
  const std::vector<Entry> before = std::exchange(entries_, {});
  scene_ = &scene;
  for (const ContactPair& each : contact_pairs(scene)) {
    Entry entry{scene.contacts[each.contact].name, pair_name(scene, each.pair), {}, 0};
    const auto same = std::ranges::find_if(before, [&entry](const Entry& other) {
      return other.contact == entry.contact && other.pair == entry.pair;
    });
    entries_.push_back(same == before.end() ? std::move(entry) : *same);
  }
}

void ContactLog::note(std::span<const ContactReport> contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactStatus status = contacts[i].status;
    const bool is_news = status != ContactStatus::kUnknown && status != ContactStatus::kAbsent;
    Entry& last = entries_[i];
    if (!is_news || (last.status == status && last.since_cycle == contacts[i].since_cycle))
      continue;
    last.status = status;
    last.since_cycle = contacts[i].since_cycle;
    if (lines_ == kLines) {
      ++left_out_;
      continue;
    }
    ++lines_;
    log_contact(*scene_, contacts[i]);
  }
}

void ContactLog::end_second() {
  if (left_out_ > 0) log_line(lines::kContactsLeftOut, counted(left_out_, "more change"));
  lines_ = left_out_ = 0;
}

}  // namespace clearance
