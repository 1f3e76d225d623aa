#include "tests/monitor/adversary/adversary.hpp"

#include <array>
#include <cmath>
#include <ostream>

#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {
namespace {

void turn(Random& random, double angle, Pose& pose) {
  const Vec3 axis = random.in_box(1.0).normalized();
  pose.orientation = Eigen::AngleAxisd(random.uniform(-angle, angle), axis) * pose.orientation;
  pose.orientation.normalize();
}

// At one millisecond per tick, every point of a body of one metre stays well below 3 m/s.
void crawl(Random& random, Pose& pose) {
  pose.position += random.in_box(0.0005);
  turn(random, 0.0005, pose);
}

void crowd(Random& random, int tick, Pose& pose) {
  const Vec3 centre(std::sin(0.01 * tick), std::cos(0.013 * tick), 0.0);
  pose.position += 0.02 * (centre - pose.position) + random.in_box(0.02);
  turn(random, 0.01, pose);
}

// The object reverses at the walls of the room.
void fly(Random& random, double room, Vec3& velocity, Pose& pose) {
  for (int i = 0; i < 3; ++i) {
    if (std::abs(pose.position[i] + velocity[i]) > 1.5 * room) velocity[i] *= -1.0;
  }
  pose.position += velocity;
  turn(random, 0.1, pose);
}

}  // namespace

std::ostream& operator<<(std::ostream& out, Style style) {
  constexpr std::array kNames{"Crawl", "Jitter", "Spin", "Teleport", "Dart", "Bullets",
                              "Crowd", "Away",   "Late", "AllLate",  "Lost"};
  return out << kNames[static_cast<std::size_t>(style)];
}

bool falls_silent(Style style) { return style == Style::kLate || style == Style::kAllLate; }

Adversary::Adversary(const Scene& scene, Style style, double room, std::uint64_t seed)
    : scene_(scene),
      style_(style),
      room_(room),
      random_(seed),
      objects_(scene.objects.size()),
      now_ns_(kStart) {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const Object& from = scene.objects[i];
    Told& object = objects_[i];
    object.pose = from.fixed ? from.world_from_object : random_.pose(room);
    object.sent = object.now = object.before = object.pose;
    object.velocity = random_.in_box(0.3 * room);
    object.known = from.fixed;
  }
}

const Report& Adversary::tick(Monitor& monitor) {
  now_ns_ += kTick;
  ++tick_;
  std::vector<PoseSample> samples;
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    Told& object = objects_[i];
    if (scene_.objects[i].fixed) continue;
    if (!rests_) move(object);
    if (!rests_ && is_silent(object)) continue;
    object.sent = object.pose;
    PoseSample told = sample(i, object.pose, now_ns_);
    // Robots send rounded quaternions.
    told.world_from_object.orientation.coeffs() *= random_.uniform(0.9995, 1.0005);
    samples.push_back(told);
  }
  const Report& report = monitor.tick(samples, now_ns_);
  learn(monitor);
  return report;
}

void Adversary::learn(const Monitor& monitor) {
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    Told& object = objects_[i];
    const InputAge age = monitor.input_age(i);
    object.before = object.now;
    object.now = age.stale ? object.pose : object.sent;
    object.known_before = object.known;
    object.known = age.age_ns >= 0 && !(age.stale && scene_.objects[i].max_speed == kInfinity);
  }
}

bool Adversary::was_known(std::uint32_t pair) const {
  const Told& a = objects_[scene_.pairs[pair].first];
  const Told& b = objects_[scene_.pairs[pair].second];
  return a.known_before && b.known_before && a.known && b.known;
}

bool Adversary::is_silent(Told& object) {
  const double chance = random_.uniform(0.0, 1.0);
  if (style_ == Style::kLost) return chance < 0.3;
  if (style_ == Style::kAllLate) return tick_ % 90 > 30;
  if (style_ != Style::kLate) return false;
  if (object.silence == 0 && chance < 0.01) {
    object.silence = static_cast<int>(random_.uniform(1.0, 80.0));
  }
  return object.silence > 0 && --object.silence > 0;
}

void Adversary::jump(Pose& pose, double chance, double room) {
  if (random_.uniform(0.0, 1.0) < chance) pose = random_.pose(room);
}

void Adversary::move(Told& object) {
  Pose& pose = object.pose;
  switch (style_) {
    case Style::kLate:
    case Style::kAllLate:
    case Style::kCrawl:
      return crawl(random_, pose);
    case Style::kJitter:
      pose.position += random_.in_box(1e-9);
      return;
    case Style::kSpin:
      return turn(random_, 0.6, pose);
    case Style::kTeleport:
      pose.position += random_.in_box(1e-4);
      return jump(pose, 0.03, room_);
    case Style::kLost:
    case Style::kDart:
      if (tick_ % 20 > 16) pose.position += random_.in_box(0.4);
      pose.position = pose.position.cwiseMax(-1.5 * room_).cwiseMin(1.5 * room_);
      return;
    case Style::kBullets:
      return fly(random_, room_, object.velocity, pose);
    case Style::kCrowd:
      return crowd(random_, tick_, pose);
    case Style::kAway:
      pose.position += random_.in_box(0.001);
      return jump(pose, 0.01, random_.uniform(0.0, 1.0) < 0.3 ? 3e4 : room_);
  }
}

}  // namespace clearance::test
