#include "config/cell/shares.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
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
  // `all`: something may ask for any place.
  Needs(Scene& scene, bool all)
      : scene_(scene), objects_(scene.objects.size()), robots_(scene.robots.size()) {
    if (all) note_all();
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
    for (JointVariable& variable : scene_.variables)
      variable.is_read = variable.is_read && robots_[variable.robot];
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
    if (!zone.pairs.empty()) continue;
    zone.separation.reset();
    zone.stop_margin.reset();
  }
  for (AllowedContact& contact : scene.contacts) keep(now, contact.pairs);
  Needs(scene, share == 0 && cell.ros.moveit.any()).mark();
  cell.topics = topics_of_share(cell.topics, shares.all[share].name);
  cell.questions.from.clear();
  cell.ros.outputs = {};
  cell.ros.trajectories.topics.clear();
}

// The costs were measured on one core (tools/bench/measured). A tracked query takes 65 ns with two
// polyhedra, about 200 ns with a curved body, and about 1,300 ns with the object of a sensor. A
// pair that is not evaluated costs about 0.6 ns a tick, because its bounds are kept (300 us for
// 499,500 pairs whose objects all move): kKeptCost.
std::uint64_t evaluation_cost(const std::vector<Object>& objects, const ObjectPair& pair) noexcept {
  constexpr std::uint64_t kPolyhedra = 1000, kCurved = 3000, kSeen = 20'000;
  const Object& a = objects[pair.first];
  const Object& b = objects[pair.second];
  const auto is_curved = [](const Part& part) { return part.shape.is_curved(); };
  std::uint64_t query = kPolyhedra;
  if (std::ranges::any_of(a.parts, is_curved) || std::ranges::any_of(b.parts, is_curved))
    query = kCurved;
  if (a.is_seen() || b.is_seen()) query = kSeen;
  // Bounds of parts leave most part pairs out.
  const std::uint64_t queries = std::max<std::uint64_t>({1, a.parts.size(), b.parts.size()});
  return query * queries;
}

std::vector<std::uint64_t> expected_costs(const std::vector<Object>& objects,
                                          const std::vector<ObjectPair>& pairs) {
  constexpr std::uint64_t kTicksAnEvaluation = 50;  // assumed for a pair that is not published
  std::vector<std::uint64_t> costs;
  costs.reserve(pairs.size());
  for (const ObjectPair& pair : pairs) {
    const std::uint64_t evaluated = evaluation_cost(objects, pair);
    costs.push_back(kKeptCost + (pair.publish ? evaluated : evaluated / kTicksAnEvaluation));
  }
  return costs;
}

std::vector<std::uint32_t> balanced_begins(const std::vector<std::uint64_t>& costs,
                                           std::uint32_t count) {
  const std::uint64_t total = std::accumulate(costs.begin(), costs.end(), std::uint64_t{0});
  std::vector<std::uint32_t> begins;
  std::uint64_t before = 0;  // of all pairs so far
  for (std::uint32_t pair = 0; pair < costs.size(); ++pair) {
    // The share in which the middle of this pair's cost lies.
    const std::uint64_t share =
        std::min<std::uint64_t>((2 * before + costs[pair]) * count / (2 * total), count - 1);
    while (begins.size() < share) begins.push_back(pair);
    before += costs[pair];
  }
  begins.resize(count - 1, static_cast<std::uint32_t>(costs.size()));
  return begins;
}

std::vector<Share> shares_of_runs(std::size_t pairs, const std::vector<std::uint32_t>& begins) {
  std::vector<Share> shares(begins.size() + 1);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const std::size_t begin = i == 0 ? 0 : begins[i - 1];
    const std::size_t end = i < begins.size() ? begins[i] : pairs;
    shares[i].name = std::to_string(i + 1);
    for (std::size_t pair = begin; pair < end; ++pair)
      shares[i].pairs.push_back(static_cast<std::uint32_t>(pair));
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
