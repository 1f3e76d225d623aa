#include "monitor/dds/contact_log.hpp"

#include <string>

#include "monitor/app/log_lines.hpp"
#include "monitor/contact_text.hpp"
#include "monitor/pair_name.hpp"

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

void ContactLog::take_over(const ContactLog& before, const SceneMap& map) {
  for (std::size_t i = 0; i < logged_.size(); ++i) {
    if (map.contact_pairs[i] != SceneMap::kNone) logged_[i] = before.logged_[map.contact_pairs[i]];
  }
}

void ContactLog::note(std::span<const ContactReport> contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactStatus status = contacts[i].status;
    const bool is_news = status != ContactStatus::kUnknown && status != ContactStatus::kAbsent;
    if (!is_news || logged_[i] == status) continue;
    logged_[i] = status;
    if (lines_ == kLines) {
      ++left_out_;
      continue;
    }
    ++lines_;
    log_contact(scene_, contacts[i]);
  }
}

void ContactLog::end_second() {
  if (left_out_ > 0) log_line(lines::kContactsLeftOut, counted(left_out_, "more change"));
  lines_ = left_out_ = 0;
}

}  // namespace clearance
