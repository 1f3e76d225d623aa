// Goes through both recordings in step, one cycle at a time. Inputs are compared before results, so
// that a difference of results is one of the daemons, not of what they were given.
#include "monitor/replay/recordings_difference.hpp"

#include <fmt/format.h>

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
    const std::uint64_t cycle_a = (*a.report)->cycle, cycle_b = (*b.report)->cycle;
    if (cycle_a != cycle_b) {
      const bool only_first = cycle_a < cycle_b;
      if (result_.compared > 0) {
        tell(only_first ? a : b, {Kind::kMissing, fmt::format("only {} has a report of this cycle",
                                                              names_[only_first ? 0 : 1])});
        return false;
      }
      (only_first ? first_ : second_).pop();
      return true;
    }
    if (result_.compared++ == 0) result_.first_cycle = cycle_a;
    result_.last_cycle = cycle_a;
    if (const Found found = difference(a, b)) {
      tell(a, *found);
      return false;
    }
    used_ = numbers_of(**a.report);
    first_.pop();
    second_.pop();
    return true;
  }

  Found difference(const RecordedTick& a, const RecordedTick& b) {
    const clearance_msg_Distances& first = **a.report;
    const clearance_msg_Distances& second = **b.report;
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

  Found other_result(const RecordedTick& a, const RecordedTick& b) {
    std::set<std::string> not_recorded = first_.not_recorded();
    not_recorded.insert(second_.not_recorded().begin(), second_.not_recorded().end());
    const Scene& scene = first_.names((*a.report)->scene_revision);
    const DifferenceOptions options{
        .not_recorded = &not_recorded, .first = names_[0], .second = names_[1]};
    if (Found found = other(scene, "", a.report, b.report, options)) return found;
    if (Found found = other(scene, "separation.", a.separation, b.separation, options))
      return found;
    if (Found found = other(scene, "gradients.", a.gradients, b.gradients, options)) return found;
    return other_zones(scene, options);
  }

  // Topics that one recording was made without are not compared.
  template <class Message>
  Found other(const Scene& scene, const char* topic, const std::optional<Sample<Message>>& a,
              const std::optional<Sample<Message>>& b, const DifferenceOptions& options) const {
    if (!a || !b) return std::nullopt;
    Message first = **a, second = **b;  // they share the buffers
    if (some_without_pairs_ && (first.pairs._length == 0 || second.pairs._length == 0))
      first.pairs._length = second.pairs._length = 0;
    if (const auto found = message_difference(scene, first, second, options))
      return Finding{Kind::kResult, topic + *found};
    return std::nullopt;
  }

  // States are written when they change, and again at other times. So states of one cycle are
  // compared whole, and others only by what is active.
  Found other_zones(const Scene& scene, const DifferenceOptions& options) const {
    for (const auto& [zone, first] : first_.zones()) {
      const clearance_msg_ZoneState* const second = second_.zone(zone);
      if (second == nullptr) continue;
      if (first.cycle == second->cycle) {
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
    result_.cycle = (*tick.report)->cycle;
    result_.now_ns = (*tick.report)->now_ns;
    result_.what = std::move(found.what);
    if (found.kind != Kind::kResult) return;
    if (without_batches_)
      result_.what += "; a recording lacks the batches, so their content was not compared";
    if (result_.first_cycle > 1)
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
    if (result_.error.empty() && result_.compared == 0 && !result_.stopped)
      result_.error = fmt::format("no cycle has a report in both {} and {}{}{}", names_[0],
                                  names_[1], result_.damage.empty() ? "" : "; ", result_.damage);
  }

  std::string names_[2];
  RecordedTicks first_, second_;
  bool some_without_pairs_ = false;
  bool without_batches_ = false;
  Numbers used_;  // in the cycle before
  RecordingsDifference result_;
};

}  // namespace

RecordingsDifference compare_recordings(const std::filesystem::path& first,
                                        const std::filesystem::path& second,
                                        const std::function<bool()>& stop) {
  return TwoRecordings(first, second).compare(stop);
}

}  // namespace clearance
