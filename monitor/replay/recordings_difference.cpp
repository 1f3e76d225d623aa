// Goes through both recordings in step, one cycle at a time. Ticks of one lineage were told the
// same time, so the time shows which of two ticks that do not belong together comes first. Inputs
// are compared before results, so that a difference of results is one of the daemons, not of what
// they were given.
#include "monitor/replay/recordings_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "monitor/replay/message_difference.hpp"
#include "monitor/replay/recorded_ticks.hpp"

namespace clearance {
namespace {

using Kind = RecordingsDifference::Kind;
using Numbers = std::map<std::string, std::uint64_t>;  // the last batch used, by source

struct Finding {
  Kind kind;
  std::string what;
};
using Found = std::optional<Finding>;

bool are_partners(const clearance_msg_Distances& a, const clearance_msg_Distances& b) {
  return a.lineage != 0 && b.lineage != 0;
}

Numbers numbers_of(const clearance_msg_Distances& report) {
  Numbers numbers;
  for (std::uint32_t i = 0; i < report.sources._length; ++i)
    numbers[report.sources._buffer[i].source] = report.sources._buffer[i].sequence_number;
  return numbers;
}

class TwoRecordings {
 public:
  TwoRecordings(const std::filesystem::path& first, const std::filesystem::path& second)
      : names_{first.string(), second.string()}, first_(first), second_(second) {
    some_without_pairs_ = outline(first).some_without_pairs || outline(second).some_without_pairs;
  }

  RecordingsDifference compare(const std::function<bool()>& stop) {
    for (;;) {
      if (stop && stop()) {
        result_.stopped = true;
        break;
      }
      const RecordedTick* const a = first_.front();
      const RecordedTick* const b = second_.front();
      if (a == nullptr || b == nullptr) break;
      if (!compare(*a, *b)) break;
    }
    end();
    return std::move(result_);
  }

 private:
  // False: the comparison is over.
  bool compare(const RecordedTick& a, const RecordedTick& b) {
    const clearance_msg_Distances& report_a = a.report;
    const clearance_msg_Distances& report_b = b.report;
    partners_ = are_partners(report_a, report_b);
    if (partners_ && report_a.lineage != report_b.lineage) {
      some_apart_ = true;
      leave_out(report_a.now_ns <= report_b.now_ns, report_b.now_ns <= report_a.now_ns);
      return true;
    }
    if (report_a.cycle != report_b.cycle) {
      const bool only_first = report_a.cycle < report_b.cycle;
      if (in_stretch_) {
        tell(only_first ? a : b, {Kind::kMissing, fmt::format("only {} has a report of this cycle",
                                                              names_[only_first ? 0 : 1])});
        return false;
      }
      leave_out(only_first, !only_first);
      return true;
    }
    note_compared(report_a);
    if (const Found found = difference(a, b)) {
      tell(a, *found);
      return false;
    }
    used_ = numbers_of(a.report);
    first_.pop();
    second_.pop();
    return true;
  }

  void leave_out(bool of_first, bool of_second) {
    in_stretch_ = false;
    skipped_[0] += of_first ? 1 : 0;
    skipped_[1] += of_second ? 1 : 0;
    if (of_first) first_.pop();
    if (of_second) second_.pop();
  }

  void note_compared(const clearance_msg_Distances& report) {
    if (result_.compared++ == 0) result_.first_cycle = report.cycle;
    result_.last_cycle = report.cycle;
    result_.left_out = skipped_;
    if (!std::exchange(in_stretch_, true)) {
      result_.stretches.push_back({report.cycle, report.cycle});
      stretch_began_ns_ = report.now_ns;
      used_.clear();
    }
    result_.stretches.back().last = report.cycle;
  }

  Found difference(const RecordedTick& a, const RecordedTick& b) {
    const clearance_msg_Distances& first = a.report;
    const clearance_msg_Distances& second = b.report;
    if (first.scene_revision != second.scene_revision)
      return Finding{Kind::kScene,
                     both("scene_revision", first.scene_revision, second.scene_revision)};
    if (Found found = other_inputs(numbers_of(first), numbers_of(second))) return found;
    if (first.now_ns != second.now_ns)
      return Finding{Kind::kTime, both("now_ns", first.now_ns, second.now_ns)};
    if (first.clock_offset_ns != second.clock_offset_ns)
      return Finding{Kind::kTime,
                     both("clock_offset_ns", first.clock_offset_ns, second.clock_offset_ns)};
    return other_result(a, b);
  }

  Found other_inputs(const Numbers& first, const Numbers& second) {
    Numbers all = first;
    all.insert(second.begin(), second.end());
    for (const auto& [source, number] : all) {
      const auto a = first.find(source), b = second.find(source);
      if (a == first.end() || b == second.end())
        return Finding{Kind::kInputs, fmt::format("only in {} batches of source '{}' were used",
                                                  names_[a == first.end() ? 1 : 0], source)};
      // Partners number some sources apart. They have compared the content when they ticked.
      if (a->second != b->second && partners_) {
        numbered_apart_ = source;
        continue;
      }
      if (a->second != b->second)
        return Finding{Kind::kInputs, both(fmt::format("the last batch of source '{}'", source),
                                           a->second, b->second)};
      if (Found found = other_batches(source, number)) return found;
    }
    return std::nullopt;
  }

  // The batches of a source that came since the cycle before, up to this number.
  Found other_batches(const std::string& source, std::uint64_t number) {
    if (!first_.has_batches_of(source) || !second_.has_batches_of(source)) {
      without_batches_ = true;
      return std::nullopt;
    }
    const auto used = used_.find(source);
    const bool follows = used != used_.end() && used->second <= number;
    const std::uint64_t from = follows ? used->second + 1 : number;
    auto a = first_.batches().lower_bound({source, from});
    auto b = second_.batches().lower_bound({source, from});
    const auto end_a = first_.batches().upper_bound({source, number});
    const auto end_b = second_.batches().upper_bound({source, number});
    if (partners_) return other_contents(source, {a, end_a}, {b, end_b});
    for (; from <= number && (a != end_a || b != end_b); ++a, ++b) {
      const bool only_first = b == end_b || (a != end_a && a->first < b->first);
      if (a == end_a || b == end_b || a->first != b->first)
        return Finding{
            Kind::kInputs,
            fmt::format("only {} has batch {} of source '{}'", names_[only_first ? 0 : 1],
                        only_first ? a->first.second : b->first.second, source)};
      if (a->second.cdr != b->second.cdr)
        return Finding{Kind::kInputs, fmt::format("batch {} of source '{}' has another content",
                                                  a->first.second, source)};
    }
    return std::nullopt;
  }

  // Partners tick the same batches within a lineage. Before they joined, one of them may have used
  // a batch already, so that it stands elsewhere in its recording.
  using Batches = std::map<RecordedTicks::BatchKey, RecordedTicks::Batch>::const_iterator;
  Found other_contents(const std::string& source, std::pair<Batches, Batches> first,
                       std::pair<Batches, Batches> second) const {
    auto& [a, end_a] = first;
    auto& [b, end_b] = second;
    while (a != end_a && b != end_b) {
      if (a->first != b->first) {
        ++(a->first < b->first ? a : b);
        continue;
      }
      if (a->second.cdr != b->second.cdr)
        return Finding{Kind::kInputs, fmt::format("batch {} of source '{}' has another content",
                                                  a->first.second, source)};
      ++a;
      ++b;
    }
    return std::nullopt;
  }

  Found other_result(const RecordedTick& a, const RecordedTick& b) {
    std::set<std::string> not_recorded = first_.not_recorded();
    not_recorded.insert(second_.not_recorded().begin(), second_.not_recorded().end());
    const Scene& scene = first_.names(a.report.scene_revision);
    const DifferenceOptions options{
        .not_recorded = &not_recorded, .first = names_[0], .second = names_[1]};
    if (Found found = other(scene, "", &a.report, &b.report, options)) return found;
    if (Found found = other(scene, "separation.", a.separation, b.separation, options))
      return found;
    if (Found found = other(scene, "gradients.", a.gradients, b.gradients, options)) return found;
    return other_zones(scene, options);
  }

  // Topics that one recording was made without are not compared.
  template <class Message>
  Found other(const Scene& scene, const char* topic, const Message* a, const Message* b,
              const DifferenceOptions& options) const {
    if (a == nullptr || b == nullptr) return std::nullopt;
    Message first = *a, second = *b;  // they share the buffers
    if (some_without_pairs_ && (first.pairs._length == 0 || second.pairs._length == 0))
      first.pairs._length = second.pairs._length = 0;
    if (const auto found = message_difference(scene, first, second, options))
      return Finding{Kind::kResult, topic + *found};
    return std::nullopt;
  }

  // States are written when they change, and again at other times. So states of one cycle are
  // compared whole, and others only by what is active. Before they joined, partners had cycles of
  // the same numbers with other inputs.
  Found other_zones(const Scene& scene, const DifferenceOptions& options) const {
    for (const auto& [zone, first] : first_.zones()) {
      const clearance_msg_ZoneState* const second = second_.zone(zone);
      if (second == nullptr) continue;
      const bool is_of_stretch =
          std::min(first.now_ns, second->now_ns) >= stretch_began_ns_ || !partners_;
      if (first.cycle == second->cycle && is_of_stretch) {
        if (const auto found = message_difference(scene, first, *second, options))
          return Finding{Kind::kResult, fmt::format("zone '{}'.{}", first.name, *found)};
      } else if (first.active != second->active) {
        return Finding{Kind::kResult, both(fmt::format("zone '{}'.active", first.name),
                                           first.active, second->active)};
      }
    }
    return std::nullopt;
  }

  template <class Value>
  [[nodiscard]] std::string both(const std::string& what, Value first, Value second) const {
    return fmt::format("{}: {} {}, {} {}", what, names_[0], first, names_[1], second);
  }

  void tell(const RecordedTick& tick, Finding found) {
    result_.kind = found.kind;
    result_.cycle = tick.report.cycle;
    result_.now_ns = tick.report.now_ns;
    result_.what = std::move(found.what);
    if (found.kind != Kind::kResult) return;
    if (without_batches_)
      result_.what += "; a recording lacks the batches, so their content was not compared";
    if (!numbered_apart_.empty())
      result_.what += fmt::format(
          "; both number the batches of source '{}' apart, so their content was not "
          "compared",
          numbered_apart_);
    if (result_.first_cycle > 1 && !partners_)
      result_.what +=
          fmt::format("; inputs before cycle {} are not in both recordings and may be the reason",
                      result_.first_cycle);
    const std::string builds[] = {first_.about("build"), second_.about("build")};
    if (builds[0] != builds[1])
      result_.what += fmt::format("; another build may be the reason: {} '{}', {} '{}'", names_[0],
                                  builds[0], names_[1], builds[1]);
  }

  void end() {
    const RecordedTicks* const both[] = {&first_, &second_};
    for (std::size_t i = 0; i < 2; ++i) {
      if (const std::string error = both[i]->error(); !error.empty())
        result_.error = fmt::format("{}: {}", names_[i], error);
      if (const std::string damage = both[i]->damage(); !damage.empty())
        result_.damage = fmt::format("{}: {}", names_[i], damage);
    }
    if (!result_.error.empty() || result_.compared > 0 || result_.stopped) return;
    const std::string_view why = some_apart_ ? ": these partners never ticked the same inputs" : "";
    result_.error = fmt::format("no cycle has a report in both {} and {}{}{}{}", names_[0],
                                names_[1], why, result_.damage.empty() ? "" : "; ", result_.damage);
  }

  std::string names_[2];
  RecordedTicks first_, second_;
  bool some_without_pairs_ = false;
  bool without_batches_ = false;
  bool partners_ = false;    // of the ticks at hand
  bool some_apart_ = false;  // a tick was left out because of its lineage
  bool in_stretch_ = false;  // the ticks before were compared
  std::int64_t stretch_began_ns_ = 0;
  std::array<std::uint64_t, 2> skipped_{};
  std::string numbered_apart_;  // a source
  Numbers used_;                // in the cycle before
  RecordingsDifference result_;
};

}  // namespace

RecordingsDifference compare_recordings(const std::filesystem::path& first,
                                        const std::filesystem::path& second,
                                        const std::function<bool()>& stop) {
  return TwoRecordings(first, second).compare(stop);
}

}  // namespace clearance
