#include "tools/bench/beside_person.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/tick/monitor.hpp"
#include "tools/bench/random.hpp"

namespace clearance::bench {
namespace {

constexpr std::size_t kJoints = 7;
constexpr double kGrowth = 2.0;   // of the override, per second
constexpr int kWalks = 3;         // of the person
constexpr double kProgram = 0.6;  // of the velocity limit: the swing
constexpr double kSlow = 0.25;    // of the program's speed, in the zone `slow`
constexpr double kSpacing = 0.1;  // s: of the recorded postures that a motion goes through
constexpr std::int64_t kFirst = 1'000'000'000'000;  // ns

using Posture = std::array<double, kJoints>;

// A smooth motion through postures that have equal intervals.
class Motion {
 public:
  Motion(std::vector<Posture> rows, double interval) : rows_(std::move(rows)), dt_(interval) {}

  [[nodiscard]] double length() const { return dt_ * static_cast<double>(rows_.size() - 1); }
  // Positions, and their first and second derivatives, at a time of the motion.
  [[nodiscard]] std::array<Posture, 3> at(double time) const {
    const double place = std::clamp(time / dt_, 0.0, static_cast<double>(rows_.size() - 1) - 1e-9);
    const auto i = static_cast<std::size_t>(place);
    const double u = place - static_cast<double>(i);
    const auto row = [&](std::size_t k) -> const Posture& {
      return rows_[std::min(k < 1 ? 0 : k - 1, rows_.size() - 1)];
    };
    std::array<Posture, 3> out{};
    for (std::size_t j = 0; j < kJoints; ++j) {
      // A uniform cubic spline near the postures: its second derivative is continuous.
      const double a = row(i)[j], b = row(i + 1)[j], c = row(i + 2)[j], d = row(i + 3)[j];
      const double v = 1.0 - u;
      out[0][j] = (v * v * v * a + (3 * u * u * u - 6 * u * u + 4) * b +
                   (3 * v * v * v - 6 * v * v + 4) * c + u * u * u * d) /
                  6.0;
      out[1][j] = (-v * v * a + (3 * u * u - 4 * u) * b - (3 * v * v - 4 * v) * c + u * u * d) /
                  (2.0 * dt_);
      out[2][j] = (v * a + (3 * u - 2) * b + (3 * v - 2) * c + u * d) / (dt_ * dt_);
    }
    return out;
  }
  // The largest absolute values of both derivatives.
  [[nodiscard]] std::array<Posture, 2> largest() const {
    std::array<Posture, 2> most{};
    for (double t = 0.0; t <= length(); t += 0.1 * dt_) {
      const auto found = at(t);
      for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t j = 0; j < kJoints; ++j)
          most[k][j] = std::max(most[k][j], std::abs(found[k + 1][j]));
    }
    return most;
  }
  void speed_up(double factor) { dt_ /= factor; }

 private:
  std::vector<Posture> rows_;
  double dt_;
};

// The first joint of a stretched arm, from one place to the other.
Motion swing() {
  std::vector<Posture> rows;
  for (int i = 0; i <= 30; ++i)
    rows.push_back({-0.9 * std::cos(std::numbers::pi * i / 30), 1.1, 0, 0.2, 0, 0.3, 0});
  return {rows, kSpacing};
}

// A CSV with the time in ns and then positions. The arm has the range of another arm's joint,
// perhaps with the other sign.
std::optional<Motion> read_motion(const std::filesystem::path& file, const Scene& scene) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::vector<Posture> rows;
  std::array<bool, kJoints> is_turned{};
  double next = -kInfinity;
  while (std::getline(in, line)) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream numbers(line);
    double ns = 0.0;
    Posture row{};
    if (!(numbers >> ns) || 1e-9 * ns < next) continue;
    next = std::max(next == -kInfinity ? 1e-9 * ns : next, 1e-9 * ns - kSpacing) + kSpacing;
    for (std::size_t j = 0; j < kJoints; ++j) {
      if (!(numbers >> row[j])) return std::nullopt;
      const JointVariable& of = scene.variables[j];
      is_turned[j] |=
          (row[j] < of.lower || row[j] > of.upper) && -row[j] >= of.lower && -row[j] <= of.upper;
    }
    rows.push_back(row);
  }
  if (rows.size() < 4) return std::nullopt;
  for (Posture& row : rows) {
    for (std::size_t j = 0; j < kJoints; ++j) {
      const JointVariable& of = scene.variables[j];
      row[j] = std::clamp(is_turned[j] ? -row[j] : row[j], of.lower + 0.05, of.upper - 0.05);
    }
  }
  return Motion(std::move(rows), kSpacing);
}

enum class Obeyed : std::uint8_t { kZones, kSeparation, kStops };

struct Outcome {
  double at_full_speed = 0.0;  // share of the time
  double progress = 0.0;       // mean share of the program's speed
  double least_m = kInfinity;  // distance from the person while the arm moves
};

// The arm on its motion, back and forth. A command acts after the reaction, and the arm brakes on
// its path within its table.
class Arm {
 public:
  Arm(const Scene& scene, const Motion& motion) : scene_(scene), motion_(motion) {}

  [[nodiscard]] double share() const { return share_; }
  [[nodiscard]] bool is_at_full_speed() const { return cap_ >= 1.0; }
  [[nodiscard]] bool stands() const { return share_ == 0.0; }

  void sample(std::int64_t stamp_ns, std::vector<JointSample>& out) const {
    const auto now = motion_.at(place_);
    out.clear();
    for (std::uint32_t v = 0; v < scene_.variables.size(); ++v) {
      JointSample& sample = out.emplace_back();
      sample.variable = v;
      sample.stamp_ns = stamp_ns;
      sample.position = v < kJoints ? now[0][v] : 0.02;
      sample.has_velocity = true;
      sample.velocity = v < kJoints ? side_ * share_ * now[1][v] : 0.0;
    }
  }
  // One period on, after a report that allows this share of the program's speed.
  void advance(double allowed, double dt) {
    commands_.push_back(allowed);
    const auto wait = static_cast<std::size_t>(scene_.robots[0].stopping.reaction / dt);
    if (commands_.size() > wait) {
      cap_ = commands_.front();
      commands_.pop_front();
    }
    const double left = side_ > 0.0 ? motion_.length() - place_ : place_;
    const double before = share_;
    if (share_ > cap_) {
      if (deceleration_ == 0.0) deceleration_ = share_ / braking_time();
      share_ = std::max(cap_, share_ - deceleration_ * dt);
    } else {
      deceleration_ = 0.0;
      const double wanted = std::min({1.0, cap_, std::sqrt(2.0 * kGrowth * left)});
      share_ += std::clamp(wanted - share_, -kGrowth * dt, kGrowth * dt);
    }
    place_ += side_ * 0.5 * (before + share_) * dt;
    if (left < 2e-3) side_ = -side_;
  }

 private:
  // At a constant deceleration, a joint goes half as far as without brakes. If the path is left in
  // a stop, slowing down on the path needs no longer than the stop of any joint.
  [[nodiscard]] double braking_time() const {
    const auto now = motion_.at(place_);
    double in_proportion = 1e-6, longest = 1e-6, shortest = kInfinity;
    const Robot& robot = scene_.robots[0];
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      if (robot.joints[j].variable >= kJoints || variables_of(robot.joints[j].type) != 1) continue;
      const double speed = std::abs(share_ * now[1][robot.joints[j].variable]);
      if (!(speed > 0.0)) continue;
      const JointStop& stop = robot.stopping.joints[j];
      in_proportion = std::max(in_proportion, stop.distance(speed) / speed);
      longest = std::max(longest, stop.time(speed));
      shortest = std::min({shortest, stop.time(speed), 2.0 * stop.distance(speed) / speed});
    }
    if (!robot.stopping.keeps_path && shortest < kInfinity) return shortest;
    return std::min(longest, 2.0 * in_proportion);
  }

  const Scene& scene_;
  const Motion& motion_;
  std::deque<double> commands_;
  double place_ = 0.0, share_ = 0.0, cap_ = 0.0, side_ = 1.0, deceleration_ = 0.0;
};

double allowed(const Scene& scene, const Report& report, Obeyed obeyed, double share) {
  double scaling = 1.0;
  if (obeyed == Obeyed::kZones) {
    for (std::size_t z = 0; z < scene.zones.size(); ++z) {
      if (!report.zones[z].active) continue;
      if (scene.zones[z].name == "stop") scaling = 0.0;
      if (scene.zones[z].name == "slow") scaling = std::min(scaling, kSlow);
    }
    return scaling;
  }
  if (obeyed == Obeyed::kSeparation)
    for (const ZoneSeparation& zone : report.separated_zones)
      scaling = std::min(scaling, zone.scaling);
  else
    for (const RobotStop& stop : report.stops) scaling = std::min(scaling, stop.scaling);
  return scaling < 1.0 ? scaling * share : 1.0;
}

// The person walks back and forth past the arm, as the seed says.
class Walk {
 public:
  explicit Walk(std::uint64_t seed) {
    Random draw(seed);
    aside_ = draw.uniform(0.9, 1.6);
    rate_ = draw.uniform(0.6, 1.4) / kHalf;
    phase_ = draw.uniform(0.0, 2.0 * std::numbers::pi);
  }
  [[nodiscard]] Vec3 at(double t) const {
    return {aside_, kHalf * std::sin(rate_ * t + phase_), 0.0};
  }

 private:
  static constexpr double kHalf = 2.2;  // m to each side; the speed is at most 1.4 m/s
  double aside_, rate_, phase_;
};

Outcome run_once(const Scene& scene, const Motion& motion, Obeyed obeyed, std::uint64_t seed,
                 double seconds) {
  const auto person = static_cast<std::uint32_t>(
      std::ranges::find(scene.objects, "person", &Object::name) - scene.objects.begin());
  Monitor monitor(scene);
  Arm arm(scene, motion);
  const Walk walk(seed);
  const double dt = 1.0 / scene.rate_hz;
  std::vector<JointSample> joints;
  std::vector<PoseSample> poses(1);
  Outcome outcome;
  const int ticks = static_cast<int>(seconds / dt);
  for (int i = 0; i < ticks; ++i) {
    const std::int64_t now = kFirst + static_cast<std::int64_t>(1e9 * dt) * i;
    arm.sample(now, joints);
    poses[0].object = person;
    poses[0].stamp_ns = now;
    poses[0].world_from_object.position = walk.at(dt * i);
    const Report& report = monitor.tick(poses, joints, now);
    outcome.at_full_speed += arm.is_at_full_speed();
    outcome.progress += arm.share();
    for (const PairReport& pair : report.pairs) {
      const ObjectPair& of = scene.pairs[pair.pair];
      if (!arm.stands() && (of.first == person || of.second == person))
        outcome.least_m = std::min(outcome.least_m, pair.lower);
    }
    arm.advance(allowed(scene, report, obeyed, arm.share()), dt);
  }
  outcome.at_full_speed /= ticks;
  outcome.progress /= ticks;
  return outcome;
}

// States how fast the joints change their velocities on this motion.
void state_accelerations(const Motion& motion, Scene& scene) {
  RobotStops& stops = scene.robots[0].stopping;
  const auto most = motion.largest();
  for (std::size_t j = 0; j < scene.robots[0].joints.size(); ++j) {
    const std::uint32_t v = scene.robots[0].joints[j].variable;
    stops.max_accelerations[j] =
        v < kJoints ? 1.05 * most[1][v] + kGrowth * most[0][v] + 1e-3 : 1e-3;
  }
}

void print_motion(const std::string& name, const Motion& motion, Scene scene, double seconds) {
  state_accelerations(motion, scene);
  print(stdout, "| {} | {:.2f} | {:.1f} |", name, std::ranges::max(motion.largest()[0]),
        std::ranges::max(motion.largest()[1]));
  double separation = 0.0;
  for (const Obeyed obeyed : {Obeyed::kZones, Obeyed::kSeparation, Obeyed::kStops}) {
    Outcome mean;
    for (int seed = 1; seed <= kWalks; ++seed) {
      const Outcome once =
          run_once(scene, motion, obeyed, static_cast<std::uint64_t>(seed), seconds);
      mean.at_full_speed += once.at_full_speed / kWalks;
      mean.progress += once.progress / kWalks;
      mean.least_m = std::min(mean.least_m, once.least_m);
    }
    print(stdout, " {:.0f} % | {:.2f} | {:.2f} |", 100.0 * mean.at_full_speed, mean.progress,
          mean.least_m);
    if (obeyed == Obeyed::kSeparation) separation = mean.at_full_speed;
    if (obeyed == Obeyed::kStops) print(stdout, " {:.2f} |", mean.at_full_speed / separation);
  }
  print(stdout, "\n");
  std::fflush(stdout);
}

}  // namespace

int run_stops(int argc, char** argv) {
  std::filesystem::path file = CLEARANCE_CELLS "/stops.yaml";
  std::vector<std::filesystem::path> motions;
  double seconds = 60.0;
  CommandLine line{
      "An arm gets through its motion beside a person who walks past, as fast as "
      "distance zones, S_p or its stops allow.",
      ""};
  line.add({
      {"--cell", &file, "The cell: an arm of seven joints, a person, zones `stop` and `slow`"},
      {"--motion", &motions, "A CSV with the time in ns and seven positions; repeatable"},
      {"--seconds", &seconds, "Length of each run", positive_number(), shown()},
  });
  if (const auto done = parse(line, argc, argv)) return *done;
  const std::optional<Cell> cell = cell_or_errors(read_cell(file));
  if (!cell) return 3;
  const Scene& scene = cell->scene;
  if (scene.robots.size() != 1 || scene.variables.size() <= kJoints ||
      scene.robots[0].stopping.max_accelerations.empty()) {
    print(stderr, "--stops: {} has not one arm of seven joints with `stopping`\n", file.string());
    return 3;
  }
  Motion first = swing();
  first.speed_up(kProgram * scene.variables[0].max_speed / first.largest()[0][0]);
  print_motion("swing", first, scene, seconds);
  for (const std::filesystem::path& each : motions) {
    const std::optional<Motion> motion = read_motion(each, scene);
    if (!motion) {
      print(stderr, "--stops: {} is no CSV with times and seven positions\n", each.string());
      return 1;
    }
    print_motion(each.stem().string(), *motion, scene, seconds);
  }
  return 0;
}

}  // namespace clearance::bench
