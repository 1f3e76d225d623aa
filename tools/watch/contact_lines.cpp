#include "tools/watch/contact_lines.hpp"

#include <fmt/format.h>

#include <span>

#include "monitor/interface/contact_text.hpp"

namespace clearance::watch {
namespace {

std::span<const clearance_msg_ContactState> contacts(const Feed& feed) {
  const clearance_msg_Distances& report = feed.distances();
  return {report.contacts._buffer, report.contacts._length};
}

// The terms as the catalogue has them; only a number where there is none yet.
AllowedContact terms_of(const Feed& feed, std::uint32_t id) {
  AllowedContact terms;
  const clearance_msg_Catalogue* const catalogue = feed.catalogue();
  if (catalogue == nullptr || id >= catalogue->contacts._length) {
    terms.name = std::to_string(id);
    return terms;
  }
  const clearance_msg_CatalogueContact& from = catalogue->contacts._buffer[id];
  terms.name = from.name;
  terms.by = from.by;
  terms.depth = from.depth;
  terms.end.distance = from.end_distance;
  if (from.end_duration_ns >= 0) terms.end.duration_ns = from.end_duration_ns;
  if (from.end_time_ns != 0) terms.end.time_ns = from.end_time_ns;
  if (from.last_cycle != 0) terms.end.last_cycle = from.last_cycle;
  return terms;
}

std::string text_of(const Feed& feed, const clearance_msg_ContactState& state) {
  ContactReport contact;
  contact.status = static_cast<ContactStatus>(state.status);
  contact.ended = static_cast<ContactEnded>(state.ended);
  contact.depth = state.depth;
  contact.since_cycle = state.since_cycle;
  contact.ended_cycle = state.ended_cycle;
  return fmt::format("{}, {}", contact_text(terms_of(feed, state.contact), contact),
                     feed.pair_name(state.pair));
}

Style style_of(const clearance_msg_ContactState& state) {
  switch (static_cast<ContactStatus>(state.status)) {
    case ContactStatus::kAllowed:
      return Style::kGood;
    case ContactStatus::kEnded:
    case ContactStatus::kAbsent:
      return Style::kDim;
    case ContactStatus::kUnknown:
      return Style::kWarning;
    default:
      return Style::kAlarm;
  }
}

}  // namespace

std::vector<std::string> contact_texts(const Feed& feed) {
  std::vector<std::string> texts;
  for (const auto& state : contacts(feed)) texts.push_back(text_of(feed, state));
  return texts;
}

void add_contacts(std::vector<Line>& lines, const Feed& feed, std::size_t width) {
  for (const auto& state : contacts(feed))
    lines.emplace_back(width)
        .add("contact   ", Style::kDim)
        .add(text_of(feed, state), style_of(state));
}

}  // namespace clearance::watch
