// One health of several shares. The fields stand in the order of the message.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "monitor/client/sequence_view.hpp"
#include "monitor/client/share_merge.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance::client {
namespace {

using Message = clearance_msg_Health;

constexpr std::array kLargest = {
    &Message::tick_p50_us,        &Message::tick_p999_us,        &Message::tick_max_us,
    &Message::wakeup_p50_us,      &Message::wakeup_p999_us,      &Message::wakeup_max_us,
    &Message::response_p50_us,    &Message::response_p999_us,    &Message::response_max_us,
    &Message::tick_second_max_us, &Message::wakeup_second_max_us};
constexpr std::array kSums = {
    &Message::clock_steps,       &Message::overruns,      &Message::skipped_cycles,
    &Message::batches,           &Message::lost_batches,  &Message::undecodable_samples,
    &Message::dropped_reports,   &Message::other_writers, &Message::foreign_reports,
    &Message::recording_missing, &Message::late_responses};

constexpr std::array kPartnerSums = {
    &clearance_msg_PartnerHealth::compared, &clearance_msg_PartnerHealth::different,
    &clearance_msg_PartnerHealth::other_inputs, &clearance_msg_PartnerHealth::missing};

using Views = std::span<const clearance_msg_Health* const>;

// Calls use(element) for each element of a list of all shares.
template <class List, class Use>
void for_all(Views views, List Message::*member, const Use& use) {
  for (const clearance_msg_Health* view : views) {
    if (view == nullptr) continue;
    for (const auto& element : list(view->*member)) use(element);
  }
}

// -1, never seen, is the oldest.
std::int64_t older(std::int64_t a, std::int64_t b) { return a < 0 || b < 0 ? -1 : std::max(a, b); }

template <class Age>
void join_age(const Age& of, Age& out) {
  const bool is_older = older(of.age_ns, out.age_ns) != out.age_ns;
  out.stale = out.stale || of.stale;
  out.contradicted = out.contradicted || of.contradicted;
  out.age_ns = older(of.age_ns, out.age_ns);
  if (!is_older) return;
  std::memcpy(out.source, of.source, sizeof out.source);
  std::memcpy(out.other_source, of.other_source, sizeof out.other_source);
}

// The first share's entry of each input, worsened by those of the others.
template <class Age, class List>
void join_ages(Views views, List Message::*member, std::uint32_t Age::*id, Message& out) {
  std::map<std::uint32_t, Age> ages;
  for_all(views, member, [&](const Age& age) {
    const auto [at, is_new] = ages.emplace(age.*id, age);
    if (!is_new) join_age(age, at->second);
  });
  reserve_sequence(out.*member, ages.size());
  for (const auto& [number, age] : ages) {
    Age& to = (out.*member)._buffer[(out.*member)._length++];
    to = age;
    to.name = dds_string_dup(age.name);
  }
}

// Each source sends one numbered stream, which every share hears: the most that one has heard.
void join_sources(Views views, Message& out) {
  std::map<std::string, clearance_msg_SourceHealth> sources;
  for_all(views, &Message::sources, [&](const clearance_msg_SourceHealth& source) {
    const auto [at, is_new] = sources.emplace(source.source, source);
    if (is_new) return;
    clearance_msg_SourceHealth& to = at->second;
    to.batches = std::max(to.batches, source.batches);
    to.lost_batches = std::max(to.lost_batches, source.lost_batches);
    to.cut_poses = std::max(to.cut_poses, source.cut_poses);
    to.age_ns = std::max(to.age_ns, source.age_ns);
  });
  const std::size_t count = std::min<std::size_t>(sources.size(), clearance_msg_kMaxSources);
  reserve_sequence(out.sources, count);
  for (const auto& [name, source] : sources) {
    if (out.sources._length < count) out.sources._buffer[out.sources._length++] = source;
  }
}

void write_rejected(const HealthCounts::Rejected& counts, Message& out) {
  reserve_sequence(out.rejected, std::min<std::size_t>(counts.size(), 4096));
  for (const auto& [what, refused] : counts) {
    if (out.rejected._length == out.rejected._maximum) return;
    out.rejected._buffer[out.rejected._length++] = {
        dds_string_dup(what.first.c_str()), dds_string_dup(what.second.c_str()), refused.count,
        dds_string_dup(refused.last.c_str())};
  }
}

// Every share hears the same sources, and counts the same takeovers of the inputs that it reads.
void join_notes(Views views, Message& out) {
  std::map<std::string, clearance_msg_InputNote> notes;
  for_all(views, &Message::notes, [&](const clearance_msg_InputNote& note) {
    const auto [at, is_new] = notes.emplace(note.input, note);
    if (is_new) return;
    const bool contradict = at->second.velocities_contradict || note.velocities_contradict;
    if (note.takeovers > at->second.takeovers) at->second = note;
    at->second.velocities_contradict = contradict;
  });
  reserve_sequence(out.notes, std::min<std::size_t>(notes.size(), 4096));
  for (const auto& [input, note] : notes) {
    if (out.notes._length == out.notes._maximum) return;
    clearance_msg_InputNote& to = out.notes._buffer[out.notes._length++];
    to = note;
    to.input = dds_string_dup(note.input);
  }
}

// Every share hears the same inputs: the slowest response counts.
void join_responses(Views views, Message& out) {
  std::map<std::string, clearance_msg_InputResponse> responses;
  for_all(views, &Message::responses, [&](const clearance_msg_InputResponse& of) {
    const auto [at, is_new] = responses.emplace(of.input, of);
    at->second.p50_us = std::max(at->second.p50_us, of.p50_us);
    at->second.max_us = std::max(at->second.max_us, of.max_us);
  });
  std::vector<clearance_msg_InputResponse> sorted;
  for (const auto& [input, of] : responses) sorted.push_back(of);
  std::ranges::stable_sort(sorted, std::ranges::greater(), &clearance_msg_InputResponse::max_us);
  sorted.resize(std::min<std::size_t>(sorted.size(), 32));
  reserve_sequence(out.responses, sorted.size());
  for (const clearance_msg_InputResponse& of : sorted)
    out.responses._buffer[out.responses._length++] = {dds_string_dup(of.input), of.p50_us,
                                                      of.max_us};
}

// A share that has no sensor's pairs does not read it: the picture with the most rays counts.
void join_witnesses(Views views, Message& out) {
  std::map<std::array<std::string, 3>, clearance_msg_WitnessHealth> witnesses;
  for_all(views, &Message::witnesses, [&](const clearance_msg_WitnessHealth& witness) {
    const auto [at, is_new] =
        witnesses.try_emplace({witness.sensor, witness.robot, witness.link}, witness);
    if (is_new) return;
    clearance_msg_WitnessHealth& to = at->second;
    const bool is_denied = to.denied || witness.denied;
    if (witness.agreeing + witness.through > to.agreeing + to.through) to = witness;
    to.denied = is_denied;
  });
  reserve_sequence(out.witnesses, std::min<std::size_t>(witnesses.size(), 4096));
  for (const auto& [names, witness] : witnesses) {
    if (out.witnesses._length == out.witnesses._maximum) return;
    clearance_msg_WitnessHealth& to = out.witnesses._buffer[out.witnesses._length++];
    to = witness;
    to.sensor = dds_string_dup(witness.sensor);
    to.robot = dds_string_dup(witness.robot);
    to.link = dds_string_dup(witness.link);
  }
}

// The share is told first whose partners do not agree, and among these the one with the most
// differences.
void join_partners(Views views, clearance_msg_PartnerHealth& out) {
  const clearance_msg_PartnerHealth* worst = nullptr;
  const auto trouble = [](const clearance_msg_PartnerHealth& each) {
    return std::tuple(each.agrees_from == 0, each.different, each.other_inputs, each.missing);
  };
  for (const clearance_msg_Health* view : views) {
    if (view == nullptr || *view->partner.partner == '\0') continue;
    if (worst == nullptr || trouble(view->partner) > trouble(*worst)) worst = &view->partner;
  }
  if (worst == nullptr) return;
  out = *worst;
  out.leads = true;  // the one program that joins writes what has one leader
  for (auto clearance_msg_PartnerHealth::*const sum : kPartnerSums) out.*sum = 0;
}

// The number that was counted since the last time; another daemon has not counted since then.
std::uint64_t increase(std::uint64_t before, std::uint64_t now) {
  return now > before ? now - before : 0;
}

}  // namespace

void HealthCounts::take(const clearance_msg_Health& health) {
  Counts now;
  for (auto Message::*const sum : kSums) now.all.push_back(health.*sum);
  for (auto clearance_msg_PartnerHealth::*const sum : kPartnerSums)
    now.all.push_back(health.partner.*sum);
  for (const clearance_msg_RejectCount& entry : list(health.rejected))
    now.rejected[{entry.object, entry.cause}].add({entry.count, entry.last});
  if (told_.all.empty()) {
    told_ = now;
  } else if (health.daemon == daemon_) {
    for (std::size_t i = 0; i < now.all.size(); ++i)
      told_.all[i] += increase(last_.all[i], now.all[i]);
    for (const auto& [what, refused] : now.rejected)
      told_.rejected[what].add({increase(last_.rejected[what].count, refused.count), refused.last});
  }
  daemon_ = health.daemon;
  last_ = std::move(now);
}

void HealthCounts::add_to(clearance_msg_Health& sums) const {
  if (told_.all.empty()) return;
  auto told = told_.all.begin();
  for (auto Message::*const sum : kSums) sums.*sum += *told++;
  for (auto clearance_msg_PartnerHealth::*const sum : kPartnerSums) sums.partner.*sum += *told++;
}

void join_health(Views views, std::span<const HealthCounts* const> counts,
                 clearance_msg_Health& out) {
  std::string recording;
  for (const clearance_msg_Health* view : views) {
    if (view == nullptr) continue;
    for (double Message::*const largest : kLargest)
      out.*largest = std::max(out.*largest, view->*largest);
    out.now_ns = std::max(out.now_ns, view->now_ns);
    const auto size = [](std::int64_t offset_ns) { return std::abs(seconds(offset_ns)); };
    if (size(view->clock_offset_ns) > size(out.clock_offset_ns))
      out.clock_offset_ns = view->clock_offset_ns;
    // A recording that has failed is told first, and decides what readers think of all.
    if (const std::string text = view->recording; text.starts_with("recording ")) {
      recording += (recording.empty() ? "" : "; ") + text;
    } else if (!text.empty()) {
      recording = text + (recording.empty() ? "" : "; ") + recording;
    }
  }
  out.recording = dds_string_dup(recording.c_str());
  join_partners(views, out.partner);
  HealthCounts::Rejected rejected;
  for (const HealthCounts* of_share : counts) {
    of_share->add_to(out);
    for (const auto& [what, refused] : of_share->rejected()) rejected[what].add(refused);
  }
  write_rejected(rejected, out);
  join_ages(views, &Message::inputs, &clearance_msg_InputAge::object, out);
  join_ages(views, &Message::joints, &clearance_msg_JointAge::variable, out);
  join_sources(views, out);
  join_notes(views, out);
  join_responses(views, out);
  join_witnesses(views, out);
}

}  // namespace clearance::client
