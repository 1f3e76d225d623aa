#include "config/cell/shares.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "config/cell/cell.hpp"
#include "config/cell/share_topics.hpp"

namespace clearance {
namespace {

constexpr std::uint32_t kOther = std::numeric_limits<std::uint32_t>::max();

// Keeps the indices that `now` leads on, in their order.
void keep(const std::vector<std::uint32_t>& now, std::vector<std::uint32_t>& pairs) {
  std::size_t kept = 0;
  for (const std::uint32_t pair : pairs) {
    if (now[pair] != kOther) pairs[kept++] = now[pair];
  }
  pairs.resize(kept);
}

// Marks what the pairs of a scene rest on: their objects, the robots whose links these are, and
// whatever those stand on. The base of a robot comes before it.
class Needs {
 public:
  explicit Needs(Scene& scene)
      : scene_(scene), objects_(scene.objects.size()), robots_(scene.robots.size()) {
    for (const ObjectPair& pair : scene.pairs) objects_[pair.first] = objects_[pair.second] = true;
    for (std::size_t i = scene.robots.size(); i-- > 0;) note(scene.robots[i], i);
    for (const Sensor& sensor : scene.sensors) {
      if (!objects_[sensor.object]) continue;
      note(sensor.mount);
      if (sensor.is_on_tf()) note_all();
    }
    // A sensor may be mounted on any robot.
    for (std::size_t i = scene.robots.size(); i-- > 0;) note(scene.robots[i], i);
  }

  void mark() {
    for (std::size_t i = 0; i < objects_.size(); ++i) scene_.objects[i].is_read = objects_[i];
    for (JointVariable& variable : scene_.variables) variable.is_read = robots_[variable.robot];
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      if (!robots_[i]) continue;
      for (const RobotLink& link : scene_.robots[i].links) {
        if (link.object != RobotLink::kNoObject) scene_.objects[link.object].is_read = true;
      }
    }
  }

 private:
  void note(const Robot& robot, std::size_t index) {
    robots_[index] =
        robots_[index] || std::ranges::any_of(robot.links, [this](const RobotLink& link) {
          return link.object != RobotLink::kNoObject && objects_[link.object];
        });
    if (robots_[index]) note(robot.base);
  }
  // Any robot or object may carry a frame of tf.
  void note_all() {
    robots_.assign(robots_.size(), true);
    for (std::size_t i = 0; i < objects_.size(); ++i)
      objects_[i] = objects_[i] || !scene_.objects[i].is_seen();
  }
  void note(const RobotBase& base) {
    if (base.kind == RobotBase::Kind::kObject) objects_[base.object] = true;
    if (base.kind == RobotBase::Kind::kLink) robots_[base.robot] = true;
  }

  Scene& scene_;
  std::vector<bool> objects_, robots_;
};

}  // namespace

void select_share(Cell& cell, std::uint32_t share) {
  Scene& scene = cell.scene;
  Shares& shares = cell.shares;
  shares.own = share;
  shares.pairs = std::exchange(scene.pairs, {});
  std::vector<std::uint32_t> now(shares.pairs.size(), kOther);
  for (const std::uint32_t pair : shares.all[share].pairs) {
    now[pair] = static_cast<std::uint32_t>(scene.pairs.size());
    scene.pairs.push_back(shares.pairs[pair]);
  }
  for (std::uint32_t zone = 0; zone < scene.zones.size(); ++zone) {
    if (scene.zones[zone].separation) shares.separated.push_back(zone);
  }
  for (Zone& zone : scene.zones) {
    keep(now, zone.pairs);
    if (zone.pairs.empty()) zone.separation.reset();
  }
  for (AllowedContact& contact : scene.contacts) keep(now, contact.pairs);
  Needs(scene).mark();
  cell.topics = topics_of_share(cell.topics, shares.all[share].name);
  cell.questions.from.clear();
  cell.ros.outputs = {};
  cell.ros.trajectories.topics.clear();
}

// Costs as measured on one core (tools/bench/measured): a tracked query of two polyhedra takes 65
// ns, one with a curved body about 200 ns, one of what a sensor sees about 1,300 ns. Keeping the
// bound of a pair that is not evaluated costs about 0.6 ns a tick where all objects move (300 us
// for 499,500 pairs), and some pairs in a hundred are evaluated.
std::uint64_t pair_cost(const std::vector<Object>& objects, const ObjectPair& pair) noexcept {
  constexpr std::uint64_t kPolyhedra = 1000, kCurved = 3000, kSeen = 20'000;
  constexpr std::uint64_t kKept = 10;          // every pair
  constexpr std::uint64_t kEvaluatedOne = 50;  // of this many pairs that are not published
  const Object& a = objects[pair.first];
  const Object& b = objects[pair.second];
  const auto is_curved = [](const Part& part) { return part.shape.is_curved(); };
  std::uint64_t query = kPolyhedra;
  if (std::ranges::any_of(a.parts, is_curved) || std::ranges::any_of(b.parts, is_curved))
    query = kCurved;
  if (a.is_seen() || b.is_seen()) query = kSeen;
  // Bounds of parts leave most part pairs out.
  const std::uint64_t queries = std::max<std::uint64_t>({1, a.parts.size(), b.parts.size()});
  const std::uint64_t evaluated = query * queries;
  return kKept + (pair.publish ? evaluated : evaluated / kEvaluatedOne);
}

std::vector<Share> balanced_shares(const std::vector<Object>& objects,
                                   const std::vector<ObjectPair>& pairs, std::uint32_t count) {
  std::uint64_t total = 0;
  for (const ObjectPair& pair : pairs) total += pair_cost(objects, pair);
  std::vector<Share> shares(count);
  for (std::uint32_t i = 0; i < count; ++i) shares[i].name = std::to_string(i + 1);
  std::uint64_t before = 0;  // of all pairs so far
  for (std::uint32_t pair = 0; pair < pairs.size(); ++pair) {
    const std::uint64_t cost = pair_cost(objects, pairs[pair]);
    // The share in which the middle of this pair's cost lies.
    const std::uint64_t share = (2 * before + cost) * count / (2 * total);
    shares[std::min<std::uint64_t>(share, count - 1)].pairs.push_back(pair);
    before += cost;
  }
  return shares;
}

void note_zones(const std::vector<Zone>& zones, std::vector<Share>& shares) {
  std::size_t pairs = 0;
  for (const Share& share : shares) pairs += share.pairs.size();
  std::vector<std::uint32_t> share_of(pairs, 0);
  for (std::uint32_t share = 0; share < shares.size(); ++share) {
    for (const std::uint32_t pair : shares[share].pairs) share_of[pair] = share;
  }
  for (std::uint32_t zone = 0; zone < zones.size(); ++zone) {
    std::vector<bool> has(shares.size());
    for (const std::uint32_t pair : zones[zone].pairs) has[share_of[pair]] = true;
    for (std::size_t share = 0; share < shares.size(); ++share) {
      if (has[share]) shares[share].zones.push_back(zone);
    }
  }
}

}  // namespace clearance
