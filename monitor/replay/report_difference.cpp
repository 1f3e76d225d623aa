#include "monitor/replay/report_difference.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>

#include "monitor/pair_name.hpp"
#include "monitor/report.hpp"

namespace clearance {
namespace {

std::string text(double value) {
  std::array<char, 64> out;
  std::snprintf(out.data(), out.size(), "%.17g", value);
  return out.data();
}
std::string text(bool value) { return value ? "true" : "false"; }
template <class Integer>
std::string text(Integer value) {
  return std::to_string(value);
}

// Compares field by field until the first difference.
class Comparer {
 public:
  Comparer(const Scene& scene, std::uint64_t cycle_offset)
      : scene_(scene), cycle_offset_(cycle_offset) {}

  [[nodiscard]] const std::optional<std::string>& difference() const { return difference_; }

  template <class T>
  void field(const std::string& name, const T& recorded, const T& replayed) {
    if (!difference_ && !(recorded == replayed)) tell(name, text(recorded), text(replayed));
  }
  // To the bit: -0 is not 0. Any NaN is any other: what is not known has no bits worth comparing.
  void field(const std::string& name, double recorded, double replayed) {
    if (difference_ || (std::isnan(recorded) && std::isnan(replayed))) return;
    if (std::bit_cast<std::uint64_t>(recorded) != std::bit_cast<std::uint64_t>(replayed)) {
      tell(name, text(recorded), text(replayed));
    }
  }
  void field(const std::string& name, const clearance_msg_Vector3& recorded,
             const clearance_msg_Vector3& replayed) {
    field(name + ".x", recorded.x, replayed.x);
    field(name + ".y", recorded.y, replayed.y);
    field(name + ".z", recorded.z, replayed.z);
  }
  // A cycle number; 0 stands for never.
  void cycle(const std::string& name, std::uint64_t recorded, std::uint64_t replayed) {
    field(name, recorded > cycle_offset_ ? recorded - cycle_offset_ : recorded, replayed);
  }

  void bits(const std::string& where, const clearance_msg_PairDistance& recorded,
            const clearance_msg_PairDistance& replayed) {
    if (difference_) return;
    if (recorded.pair != replayed.pair) {
      tell(where + ".pair", pair_name(scene_, recorded.pair), pair_name(scene_, replayed.pair));
    }
    const std::string pair = where + " (" + pair_name(scene_, recorded.pair) + ").";
    field(pair + "status", std::string(name(static_cast<PairStatus>(recorded.status))),
          std::string(name(static_cast<PairStatus>(replayed.status))));
    field(pair + "part_a", recorded.part_a, replayed.part_a);
    field(pair + "part_b", recorded.part_b, replayed.part_b);
    field(pair + "distance", recorded.distance, replayed.distance);
    field(pair + "lower", recorded.lower, replayed.lower);
    field(pair + "upper", recorded.upper, replayed.upper);
    field(pair + "swept_lower", recorded.swept_lower, replayed.swept_lower);
    field(pair + "witness_a", recorded.witness_a, replayed.witness_a);
    field(pair + "witness_b", recorded.witness_b, replayed.witness_b);
    field(pair + "normal", recorded.normal, replayed.normal);
    field(pair + "closing_speed", recorded.closing_speed, replayed.closing_speed);
    field(pair + "time_to_contact", recorded.time_to_contact, replayed.time_to_contact);
    field(pair + "age_a_ns", recorded.age_a_ns, replayed.age_a_ns);
    field(pair + "age_b_ns", recorded.age_b_ns, replayed.age_b_ns);
    cycle(pair + "evaluated_cycle", recorded.evaluated_cycle, replayed.evaluated_cycle);
    field(pair + "refresh_age_cycles", recorded.refresh_age_cycles, replayed.refresh_age_cycles);
  }

  void bounds(const std::string& where, const clearance_msg_PairDistance& recorded,
              const clearance_msg_PairDistance& replayed) {
    if (difference_ || recorded.pair != replayed.pair) return;
    if (recorded.lower <= replayed.upper && replayed.lower <= recorded.upper) return;
    tell(where + " (" + pair_name(scene_, recorded.pair) + ") bounds",
         text(recorded.lower) + " to " + text(recorded.upper),
         text(replayed.lower) + " to " + text(replayed.upper));
  }

 private:
  static std::string text(const std::string& value) { return value; }
  template <class T>
  static std::string text(const T& value) {
    return clearance::text(value);
  }
  void tell(const std::string& name, const std::string& recorded, const std::string& replayed) {
    difference_ = name + ": recorded " + recorded + ", replayed " + replayed;
  }

  const Scene& scene_;
  std::uint64_t cycle_offset_;
  std::optional<std::string> difference_;
};

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
  compare.field("minimum_proved", recorded.minimum_proved, replayed.minimum_proved);
  compare.bits("minimum", recorded.minimum, replayed.minimum);
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
    compare.bounds("minimum", recorded.minimum, replayed.minimum);
  }
  compare.field("pairs.length", recorded.pairs._length, replayed.pairs._length);
  for (std::uint32_t i = 0; i < recorded.pairs._length && !compare.difference(); ++i) {
    const std::string where = "pairs[" + std::to_string(i) + "]";
    const clearance_msg_PairDistance& a = recorded.pairs._buffer[i];
    const clearance_msg_PairDistance& b = replayed.pairs._buffer[i];
    bits ? compare.bits(where, a, b) : compare.bounds(where, a, b);
  }
  return compare.difference();
}

}  // namespace clearance
