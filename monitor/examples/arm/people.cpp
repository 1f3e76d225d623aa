#include "monitor/examples/arm/people.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>
#include <variant>

#include "config/cell/simulation.hpp"
#include "config/text/file_bytes.hpp"
#include "monitor/examples/arm/bvh.hpp"
#include "monitor/examples/arm/made_motion.hpp"
#include "monitor/examples/arm/person_fit.hpp"
#include "monitor/examples/arm/true_body.hpp"
#include "monitor/wire/convert.hpp"
#include "tools/robot/ros_tracker.hpp"

namespace clearance::people {
namespace {

constexpr std::chrono::milliseconds kPatience(500);
constexpr std::int64_t kEndNs = 5'000'000'000;  // without a report
constexpr double kStep = 5e-3;                  // s, between two places of the arm
constexpr double kThereS = 6.0, kAwayS = 1.0;   // how long the person stays, and is gone
constexpr int kMadeFrames = 3000;

Bvh motion_of(const RunOptions& options) {
  if (options.motion.empty()) return read_bvh(walking_and_reaching(61, kMadeFrames));
  const auto text = read_bytes(options.motion);
  if (const auto* fault = std::get_if<FileFault>(&text))
    throw std::invalid_argument(options.motion + ": " + fault->reason);
  return read_bvh(std::get<std::string>(text));
}

// What was told of the person at a stamp.
struct Told {
  std::int64_t stamp_ns;
  std::vector<Limb> limbs;
};

// Where the arm and the person truly are, without the daemon.
class Truth {
 public:
  explicit Truth(const Cell& cell) : cell_(cell) {
    for (std::uint32_t i = 0; i < cell.scene.objects.size(); ++i)
      objects_[cell.scene.objects[i].name] = i;
  }
  void tell(std::int64_t stamp_ns, std::vector<Limb> limbs) {
    told_.push_back({stamp_ns, std::move(limbs)});
    if (told_.size() > kMost) told_.pop_front();
  }
  void move(std::int64_t stamp_ns, double t_s) {
    moved_[stamp_ns] = t_s;
    if (moved_.size() > kMost) moved_.erase(moved_.begin());
  }
  // Nothing: the pair is not one of a limb and a moving link of the arm, or the places of that time
  // are not known. While a new place of the person comes in, the daemon may have a part of it.
  [[nodiscard]] std::optional<double> distance_of(std::string_view limb, std::string_view link,
                                                  std::int64_t now_ns, std::int64_t limb_age_ns,
                                                  std::int64_t link_age_ns) const {
    const auto told = std::ranges::find_if(
        told_.rbegin(), told_.rend(), [&](const Told& each) { return each.stamp_ns <= now_ns; });
    if (told == told_.rend() || std::abs(now_ns - limb_age_ns - told->stamp_ns) > kSameNs)
      return std::nullopt;
    const auto object = objects_.find(std::string(link));
    if (object == objects_.end()) return std::nullopt;
    const auto capsule = capsule_at(object->second, now_ns - link_age_ns);
    if (!capsule) return std::nullopt;
    std::optional<double> least;
    for (const Limb& each : told->limbs) {
      const bool is_it =
          limb.starts_with(each.link) && limb.substr(each.link.size()).front() == '_';
      if (!is_it) continue;
      const double found = true_distance(each, *capsule);
      least = std::min(least.value_or(found), found);
    }
    return least;
  }

 private:
  static constexpr std::size_t kMost = 256;
  static constexpr std::int64_t kSameNs = 20'000;

  [[nodiscard]] std::optional<TrueCapsule> capsule_at(std::uint32_t object,
                                                      std::int64_t stamp_ns) const {
    const auto after = moved_.lower_bound(stamp_ns - kSameNs);
    if (after == moved_.end() || after->first > stamp_ns + kSameNs) return std::nullopt;
    std::vector<PoseAt> poses;
    poses_at(cell_.simulation, after->second, poses);
    const auto pose = std::ranges::find(poses, object, &PoseAt::object);
    if (pose == poses.end()) return std::nullopt;
    const Pose& world = pose->world_from_object;
    const auto& [length, radius] = sizes_.at(cell_.scene.objects[object].name);
    return TrueCapsule{world.position, world.position + world.orientation * Vec3(0, 0, length),
                       radius};
  }

  const Cell& cell_;
  std::map<std::string, std::uint32_t> objects_;
  // Of the two links of the arm, as their makers built them.
  std::map<std::string, std::pair<double, double>> sizes_ = {{"upper_arm", {0.5, 0.08}},
                                                             {"forearm", {0.5, 0.06}}};
  std::deque<Told> told_;
  std::map<std::int64_t, double> moved_;  // the arm's time, by stamps
};

// Takes all reports, and compares their lower bounds with the truth.
class Watcher {
 public:
  Watcher(client::Connection& connection, const Truth& truth, RunResult& result)
      : reports_(connection, {.old_after = kPatience, .depth = 256}),
        catalogue_(connection),
        truth_(truth),
        result_(result) {}

  // Returns whether a report came.
  bool take_all() {
    bool came = false;
    for (; reports_.next(); came = true) take();
    return came;
  }
  [[nodiscard]] std::uint64_t revision() const { return catalogue_.revision(); }

 private:
  void take() {
    ++result_.reports;
    if (cycle_ != 0) result_.missed += reports_->cycle - cycle_ - 1;
    cycle_ = reports_->cycle;
    if (catalogue_.revision() != reports_->scene_revision) catalogue_.update();
    if (catalogue_.revision() != reports_->scene_revision) return;
    const auto& pairs = catalogue_.message()->pairs;
    for (const auto& pair : std::span(reports_->pairs._buffer, reports_->pairs._length)) {
      const auto& objects = pairs._buffer[pair.pair];
      const std::string a = catalogue_.object_name(objects.object_a);
      const std::string b = catalogue_.object_name(objects.object_b);
      const auto found = truth_.distance_of(b, a, reports_->now_ns, pair.age_b_ns, pair.age_a_ns);
      if (!found || pair.age_b_ns < 0) continue;
      ++result_.compared;
      if (pair.lower > *found) ++result_.wrong;
      if (pair.lower > -kInfinity) result_.below_truth_m.push_back(*found - pair.lower);
      if (*found >= result_.least_distance_m) continue;
      result_.least_distance_m = *found;
      result_.nearest = a + " - " + b;
    }
  }

  client::Reports reports_;
  client::Catalogue catalogue_;
  const Truth& truth_;
  RunResult& result_;
  std::uint64_t cycle_ = 0;
};

}  // namespace

RunResult run(const Cell& cell, client::Connection& connection, const RunOptions& options,
              const std::function<bool()>& go_on) {
  const auto is_person = [](const Robot& robot) { return robot.person.has_value(); };
  if (!std::ranges::any_of(cell.scene.robots, is_person) || cell.simulation.chains.empty())
    throw std::invalid_argument("the cell has to have persons and a chain, as people.yaml");
  const Bvh motion = motion_of(options);
  RunResult result;
  Truth truth(cell);
  Watcher watcher(connection, truth, result);
  RosTracker tracker(connection, cell.ros.world_frame, cell.ros.moveit.tracked_bodies);
  client::PoseWriter arm(connection, "arm of two links");
  PersonFit fit;
  std::vector<PoseAt> poses;
  std::vector<clearance_msg_ObjectPose> sent;
  const std::int64_t begin_ns = client::now_ns();
  std::int64_t heard_ns = begin_ns, frame_ns = begin_ns;
  double t_s = 0.0;
  for (; t_s < options.seconds && go_on();
       std::this_thread::sleep_for(std::chrono::duration<double>(kStep))) {
    const std::int64_t now_ns = client::now_ns();
    t_s = 1e-9 * static_cast<double>(now_ns - begin_ns);
    poses_at(cell.simulation, t_s, poses);
    sent.resize(poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      to_wire({.object = poses[i].object,
               .stamp_ns = now_ns,
               .world_from_object = poses[i].world_from_object,
               .twist = poses[i].twist,
               .has_twist = true},
              sent[i]);
    }
    truth.move(now_ns, t_s);
    arm.write(sent, watcher.revision() == 0 ? cell.scene.revision : watcher.revision());
    if (now_ns >= frame_ns) {
      frame_ns += static_cast<std::int64_t>(1e9 * motion.frame_s);
      const double round = std::fmod(t_s, kThereS + kAwayS);
      const int visit = static_cast<int>(t_s / (kThereS + kAwayS)) + 1;
      const bool is_there = round < kThereS;
      const std::string id = "b" + std::to_string(visit);
      tracker.list(is_there ? std::vector{id} : std::vector<std::string>(), now_ns);
      if (is_there) {
        result.bodies = visit;
        const auto frame = static_cast<std::size_t>(t_s / motion.frame_s) % motion.frames.size();
        const Keypoints person = keypoints_of(motion, frame, options.metres);
        truth.tell(now_ns, true_limbs(person));
        tracker.tell(id, fit.fit(person), now_ns);
      }
    }
    if (watcher.take_all()) heard_ns = now_ns;
    if (now_ns - heard_ns > kEndNs) return result;
  }
  std::ranges::sort(result.below_truth_m);
  result.heard = t_s >= options.seconds;
  return result;
}

}  // namespace clearance::people
