#include "monitor/examples/arm/pick.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "monitor/examples/arm/motion.hpp"

namespace clearance::pick {
namespace {

constexpr std::chrono::milliseconds kPatience(500);
constexpr std::int64_t kEndNs = 5'000'000'000;  // without an answer
constexpr std::int64_t kLongestStepNs =
    5'000'000;  // of the motion, however long the machine stalled
constexpr double kBin = 50.0 * 3.14159265358979323846 / 180.0;  // azimuth of a bin, rad

// Heights of the fingertips: 30 mm below the top of the part, and above the wall.
constexpr double kGrasp = 0.31, kCarry = 0.56;
// Positions of the finger: its distance from the part's side is 0 at 0.018 m.
constexpr double kOpen = 0.03, kClosed = 0.0175;

const std::vector<std::string> kJointNames{"joint1", "joint2", "joint3", "joint4",
                                           "joint5", "joint6", "joint7", "finger"};

// A motion to a point, and then changes of the scene.
struct Phase {
  HandPoint to;
  double seconds;
  std::vector<CellChange> changes = {};
};

// A contact that is withdrawn later.
AllowContact contact(const char* name, const char* with, const char* reason) {
  return {.contact = name,
          .a = "part",
          .b = with,
          .depth = 0.001,
          .by = "picking arm",
          .reason = reason};
}

// A contact of what will leave each other: it ends once they were 10 mm from each other.
AllowContact last_contact(AllowContact contact) {
  contact.end.distance = 0.01;
  return contact;
}

std::vector<Phase> phases() {
  const AllowContact left = contact("left grip", "left_finger", "the fingers hold it"),
                     right = contact("right grip", "right_finger", "the fingers hold it");
  const WithdrawContact no_left{"left grip"}, no_right{"right grip"};
  return {
      {{-kBin, 0.6, kCarry, kOpen}, 2.0},
      {{-kBin, 0.6, kGrasp, kOpen}, 1.2, {left, right}},
      {{-kBin, 0.6, kGrasp, kClosed},
       0.3,
       {no_left, no_right,
        Attach{.object = "part", .to = "hand", .touch = {"left_finger", "right_finger"}},
        last_contact(contact("stand", "left_bin", "the part stands in the bin"))}},
      {{-kBin, 0.6, kCarry, kClosed}, 1.5},
      {{kBin, 0.6, kCarry, kClosed},
       2.5,
       {WithdrawContact{"stand"}, contact("put", "right_bin", "the part is put into the bin")}},
      {{kBin, 0.6, kGrasp, kClosed},
       1.5,
       {WithdrawContact{"put"}, Detach{.object = "part"}, last_contact(left), last_contact(right)}},
      {{kBin, 0.6, kGrasp, kOpen}, 0.3},
      {{kBin, 0.6, kCarry, kOpen}, 1.2, {no_left, no_right}},
  };
}

// Collects the figures of a run from its reports.
class Watcher {
 public:
  Watcher(client::Connection& connection, RunResult& result)
      : reports_(connection, {.old_after = kPatience, .depth = 8}),
        catalogue_(connection),
        zones_(connection),
        result_(result) {}

  // Waits for a report of a tick that began after the stamp.
  bool wait_for(std::int64_t stamp_ns) {
    while (reports_.next(std::chrono::milliseconds(20))) {
      take();
      if (reports_->now_ns >= stamp_ns) return true;
    }
    return false;
  }
  [[nodiscard]] std::uint64_t cycle() const { return reports_->cycle; }
  [[nodiscard]] bool all_known() const { return reports_->unknown == 0; }

 private:
  void take() {
    if (catalogue_.revision() != reports_->scene_revision) catalogue_.update();
    zones_.update(*reports_);
    for (const auto& [id, zone] : zones_.states()) {
      if (!zone.active) {
        active_.erase(zone.name);
      } else if (active_.insert(zone.name).second && all_known()) {
        ++result_.entered;
      }
    }
    // A catalogue comes a moment later than the first report of its scene.
    if (catalogue_.revision() != reports_->scene_revision) return;
    for (const auto& pair : std::span(reports_->pairs._buffer, reports_->pairs._length)) {
      const auto& objects = catalogue_.message()->pairs._buffer[pair.pair];
      const std::string a = catalogue_.object_name(objects.object_a),
                        b = catalogue_.object_name(objects.object_b);
      if ((a != "wall" && b != "wall") || !std::isfinite(pair.distance)) continue;
      result_.least_lower_m = std::min(result_.least_lower_m, pair.lower);
      if (pair.distance >= result_.least_distance_m) continue;
      result_.least_distance_m = pair.distance;
      result_.nearest = (a == "wall" ? b : a) + " - wall";
    }
  }

  client::Reports reports_;
  client::Catalogue catalogue_;
  client::Zones zones_;
  RunResult& result_;
  std::set<std::string> active_;  // names of zones
};

// The arm, what it is told to do, and the time of its motion.
class Arm {
 public:
  Arm(client::Connection& connection, RunResult& result, const std::function<bool()>& go_on)
      : joints_(connection, "picking arm", kJointNames),
        commands_(connection, "picking arm"),
        watcher_(connection, result),
        result_(result),
        go_on_(go_on) {}

  // Each returns false when the run has to end.
  bool move(const HandPoint& to, double seconds) {
    for (double time_s = 0.0; time_s < seconds;) {
      const double before_s = seconds_of(client::now_ns());
      if (!send(step_between(at_, to, time_s / seconds, seconds))) return false;
      const double spent_s = seconds_of(client::now_ns()) - before_s;
      time_s += std::min(spent_s, seconds_of(kLongestStepNs));
    }
    at_ = to;
    return send({positions_at(to), {}});
  }

  // The arm rests until the changes are in force.
  bool change(const std::vector<CellChange>& changes) {
    const std::int64_t began_ns = client::now_ns();
    const std::uint64_t request = commands_.post(changes);
    std::optional<CommandResult> answer;
    while (!(answer = commands_.result(request))) {
      if (client::now_ns() - began_ns > kEndNs || !rest()) return false;
    }
    if (!answer->done()) {
      result_.refusal = answer->path + ": " + answer->reason;
      return false;
    }
    while (watcher_.cycle() < answer->in_force_from) {
      if (!rest()) return false;
    }
    const double took_s = seconds_of(client::now_ns() - began_ns);
    result_.slowest_command_s = std::max(result_.slowest_command_s, took_s);
    return true;
  }

  // Waits until the daemon is there and knows where the arm is.
  bool begin(const HandPoint& at) {
    at_ = at;
    do {
      if (!rest()) return false;
    } while (!commands_.is_heard() || !watcher_.all_known());
    return true;
  }

 private:
  static double seconds_of(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

  bool rest() { return send({positions_at(at_), {}}); }

  // Sends joint states until a report has used them.
  bool send(const Step& step) {
    const std::int64_t began_ns = client::now_ns();
    do {
      if (!go_on_() || client::now_ns() - began_ns > kEndNs) return false;
      ++result_.steps;
      const std::int64_t stamp_ns = client::now_ns();
      joints_.write(step.positions, step.rates, stamp_ns);
      if (watcher_.wait_for(stamp_ns)) return true;
    } while (true);
  }

  client::JointWriter joints_;
  client::Commands commands_;
  Watcher watcher_;
  RunResult& result_;
  const std::function<bool()>& go_on_;
  HandPoint at_;
};

}  // namespace

// The part begins in the left bin. A daemon that is not told what the arm holds is told that there
// is no part.
RunResult run(client::Connection& connection, const RunOptions& options,
              const std::function<bool()>& go_on) {
  RunResult result;
  Arm arm(connection, result, go_on);
  if (!arm.begin({kBin, 0.6, kCarry, kOpen})) return result;
  if (!arm.change({SetAbsent{.object = "part", .absent = !options.tells}})) return result;
  for (const Phase& phase : phases()) {
    if (!arm.move(phase.to, phase.seconds / options.speed)) return result;
    if (options.tells && !phase.changes.empty() && !arm.change(phase.changes)) return result;
  }
  result.heard = true;
  return result;
}

}  // namespace clearance::pick
