#include "monitor/replay/report_difference.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <string_view>

#include "monitor/pair_name.hpp"
#include "monitor/report.hpp"

namespace clearance {
namespace {

std::string text(double value) { return fmt::format("{:.17g}", value); }
template <class T>
std::string text(const T& value) {
  return fmt::format("{}", value);
}

// Compares field by field until the first difference; no text is made before that.
class Comparer {
 public:
  Comparer(const Scene& scene, std::uint64_t cycle_offset)
      : scene_(scene), cycle_offset_(cycle_offset) {}

  [[nodiscard]] const std::optional<std::string>& difference() const { return difference_; }

  template <class T>
  void field(std::string_view name, const T& recorded, const T& replayed) {
    if (!difference_ && !(recorded == replayed)) tell(name, text(recorded), text(replayed));
  }
  // To the bit: -0 is not 0. Any NaN is any other: what is not known has no bits worth comparing.
  void field(std::string_view name, double recorded, double replayed, std::string_view axis = "") {
    if (difference_ || (std::isnan(recorded) && std::isnan(replayed))) return;
    if (std::bit_cast<std::uint64_t>(recorded) != std::bit_cast<std::uint64_t>(replayed)) {
      tell(name, text(recorded), text(replayed), axis);
    }
  }
  void field(std::string_view name, const clearance_msg_Vector3& recorded,
             const clearance_msg_Vector3& replayed) {
    field(name, recorded.x, replayed.x, ".x");
    field(name, recorded.y, replayed.y, ".y");
    field(name, recorded.z, replayed.z, ".z");
  }
  // A cycle number; 0 stands for never.
  void cycle(std::string_view name, std::uint64_t recorded, std::uint64_t replayed) {
    field(name, recorded > cycle_offset_ ? recorded - cycle_offset_ : recorded, replayed);
  }

  // `place`: in the report's list of pairs; none: the minimum.
  void bits(std::optional<std::uint32_t> place, const clearance_msg_PairDistance& recorded,
            const clearance_msg_PairDistance& replayed) {
    if (difference_) return;
    if (recorded.pair != replayed.pair) {
      tell(list_entry(place) + ".pair", pair_name(scene_, recorded.pair),
           pair_name(scene_, replayed.pair));
    }
    within_ = Entry{place, recorded.pair};
    field("status", std::string_view(name(static_cast<PairStatus>(recorded.status))),
          std::string_view(name(static_cast<PairStatus>(replayed.status))));
    field("part_a", recorded.part_a, replayed.part_a);
    field("part_b", recorded.part_b, replayed.part_b);
    field("distance", recorded.distance, replayed.distance);
    field("lower", recorded.lower, replayed.lower);
    field("upper", recorded.upper, replayed.upper);
    field("swept_lower", recorded.swept_lower, replayed.swept_lower);
    field("witness_a", recorded.witness_a, replayed.witness_a);
    field("witness_b", recorded.witness_b, replayed.witness_b);
    field("normal", recorded.normal, replayed.normal);
    field("closing_speed", recorded.closing_speed, replayed.closing_speed);
    field("time_to_contact", recorded.time_to_contact, replayed.time_to_contact);
    field("age_a_ns", recorded.age_a_ns, replayed.age_a_ns);
    field("age_b_ns", recorded.age_b_ns, replayed.age_b_ns);
    cycle("evaluated_cycle", recorded.evaluated_cycle, replayed.evaluated_cycle);
    field("refresh_age_cycles", recorded.refresh_age_cycles, replayed.refresh_age_cycles);
    within_.reset();
  }

  void bounds(std::optional<std::uint32_t> place, const clearance_msg_PairDistance& recorded,
              const clearance_msg_PairDistance& replayed) {
    if (difference_ || recorded.pair != replayed.pair) return;
    if (recorded.lower <= replayed.upper && replayed.lower <= recorded.upper) return;
    const auto interval = [](const clearance_msg_PairDistance& pair) {
      return fmt::format("{} to {}", text(pair.lower), text(pair.upper));
    };
    tell(fmt::format("{} ({}) bounds", list_entry(place), pair_name(scene_, recorded.pair)),
         interval(recorded), interval(replayed));
  }

 private:
  struct Entry {
    std::optional<std::uint32_t> place;
    std::uint32_t pair;
  };

  static std::string list_entry(std::optional<std::uint32_t> place) {
    return place ? fmt::format("pairs[{}]", *place) : "minimum";
  }
  void tell(std::string_view name, const std::string& recorded, const std::string& replayed,
            std::string_view axis = "") {
    const std::string in = within_ ? fmt::format("{} ({}).", list_entry(within_->place),
                                                 pair_name(scene_, within_->pair))
                                   : "";
    difference_ =
        fmt::format("{}{}{}: recorded {}, replayed {}", in, name, axis, recorded, replayed);
  }

  const Scene& scene_;
  std::uint64_t cycle_offset_;
  std::optional<Entry> within_;  // the pair whose fields are compared; none: the report's own
  std::optional<std::string> difference_;
};

// The tick's own fields, in the order in which a person would look for the cause: time and scene,
// then counts, then distances.
void compare_bits(Comparer& compare, const clearance_msg_Distances& recorded,
                  const clearance_msg_Distances& replayed) {
  compare.cycle("cycle", recorded.cycle, replayed.cycle);
  compare.field("now_ns", recorded.now_ns, replayed.now_ns);
  compare.field("newest_pose_ns", recorded.newest_pose_ns, replayed.newest_pose_ns);
  compare.field("oldest_pose_ns", recorded.oldest_pose_ns, replayed.oldest_pose_ns);
  compare.field("scene_revision", recorded.scene_revision, replayed.scene_revision);
  compare.field("pairs_total", recorded.pairs_total, replayed.pairs_total);
  compare.field("unknown", recorded.unknown, replayed.unknown);
  compare.field("stale", recorded.stale, replayed.stale);
  compare.field("evaluated", recorded.evaluated, replayed.evaluated);
  compare.field("carried", recorded.carried, replayed.carried);
  compare.field("queries", recorded.queries, replayed.queries);
  compare.field("oldest_evaluation_cycles", recorded.oldest_evaluation_cycles,
                replayed.oldest_evaluation_cycles);
  compare.field("minimum_known", recorded.minimum_known, replayed.minimum_known);
  compare.field("minimum_certified", recorded.minimum_certified, replayed.minimum_certified);
  compare.bits(std::nullopt, recorded.minimum, replayed.minimum);
  compare.field("lower_all", recorded.lower_all, replayed.lower_all);
  compare.field("swept_lower_all", recorded.swept_lower_all, replayed.swept_lower_all);
}

}  // namespace

std::optional<std::string> report_difference(const Scene& scene,
                                             const clearance_msg_Distances& recorded,
                                             const clearance_msg_Distances& replayed,
                                             std::uint64_t cycle_offset, Comparison comparison) {
  Comparer compare(scene, cycle_offset);
  const bool bits = comparison == Comparison::kBits;
  if (bits) {
    compare_bits(compare, recorded, replayed);
  } else {
    compare.bounds(std::nullopt, recorded.minimum, replayed.minimum);
  }
  compare.field("pairs.length", recorded.pairs._length, replayed.pairs._length);
  for (std::uint32_t i = 0; i < recorded.pairs._length && !compare.difference(); ++i) {
    const clearance_msg_PairDistance& a = recorded.pairs._buffer[i];
    const clearance_msg_PairDistance& b = replayed.pairs._buffer[i];
    bits ? compare.bits(i, a, b) : compare.bounds(i, a, b);
  }
  return compare.difference();
}

}  // namespace clearance
