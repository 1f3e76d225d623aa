// The smallest distance of a crowd in every tick by FCL's DynamicAABBTreeCollisionManager, as FCL
// is meant to be used. Only objects that moved are updated, and fixed objects have a tree of their
// own. The pair that was closest in the last tick is evaluated first, so that its distance prunes
// the trees from the beginning. FCL finds only the minimum of a tick's results: no bounds of other
// pairs, no zones, and no witness points of other pairs.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "tools/bench/clocks.hpp"
#include "tools/bench/peers/fcl_bodies.hpp"
#include "tools/bench/peers/peers.hpp"
#include "tools/bench/tick_run.hpp"
#include "tools/bench/ticks.hpp"

namespace clearance::bench {
namespace {

using Manager = fcl::DynamicAABBTreeCollisionManager<double>;
using FclObject = fcl::CollisionObject<double>;

// FCL's body, and its place in the part's frame.
struct Body {
  std::shared_ptr<fcl::CollisionGeometry<double>> geometry;
  Pose part_from_body;
};

Body body_of(const ConvexBody& shape) {
  if (shape.anchors.size() > 2) return {fcl_hull(shape), {}};
  if (shape.anchors.size() == 1) {
    return {std::make_shared<fcl::Sphere<double>>(shape.radius), {.position = shape.anchors[0]}};
  }
  const Vec3 along = shape.anchors[1] - shape.anchors[0];
  return {std::make_shared<fcl::Capsule<double>>(shape.radius, along.norm()),
          {.position = 0.5 * (shape.anchors[0] + shape.anchors[1]),
           .orientation = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), along)}};
}

class FclCrowd {
 public:
  explicit FclCrowd(const Crowd& crowd)
      : objects_(crowd.scene.objects.size()), watched_(objects_ * objects_, false) {
    for (const ObjectPair& pair : crowd.scene.pairs) {
      watched_[pair.first * objects_ + pair.second] = true;
      watched_[pair.second * objects_ + pair.first] = true;
    }
    parts_of_.resize(objects_);
    for (std::uint32_t i = 0; i < objects_; ++i) add(crowd.scene.objects[i], i);
    for (Part& part : parts_) part.body->setUserData(&part);
    fixed_.setup();
  }

  // The smallest distance over all watched pairs, m.
  double tick(const std::vector<PoseSample>& samples) {
    std::vector<FclObject*> moved;
    for (const PoseSample& sample : samples) move(sample, moved);
    update(moved);
    result_.clear();
    if (closest_a_ != nullptr) ask(closest_a_, closest_b_);
    moving_.distance(this, closer);
    if (!fixed_.empty()) moving_.distance(&fixed_, this, closer);
    return result_.min_distance;
  }

 private:
  struct Part {
    std::uint32_t object;
    Pose object_from_body;
    std::unique_ptr<FclObject> body;
  };

  void add(const Object& object, std::uint32_t index) {
    for (const clearance::Part& part : object.parts) {
      const Body body = body_of(part.shape);
      const Pose place = compose(part.object_from_part, body.part_from_body);
      parts_of_[index].push_back(parts_.size());
      parts_.push_back({index, place, std::make_unique<FclObject>(body.geometry)});
      if (!object.fixed) continue;
      put(parts_.back(), object.world_from_object);
      fixed_.registerObject(parts_.back().body.get());
    }
    last_.push_back(object.world_from_object);
  }

  static void put(Part& part, const Pose& world_from_object) {
    part.body->setTransform(fcl_transform(compose(world_from_object, part.object_from_body)));
    part.body->computeAABB();
  }

  void move(const PoseSample& sample, std::vector<FclObject*>& moved) {
    Pose& last = last_[sample.object];
    const Pose& now = sample.world_from_object;
    if (same_pose(last, now) && registered_) return;
    last = now;
    for (const std::size_t part : parts_of_[sample.object]) {
      put(parts_[part], now);
      moved.push_back(parts_[part].body.get());
    }
  }

  void update(const std::vector<FclObject*>& moved) {
    if (!registered_) {
      moving_.registerObjects(moved);
      moving_.setup();
      registered_ = true;
    } else if (2 * moved.size() > moving_.size()) {
      moving_.update();  // refits the whole tree
    } else if (!moved.empty()) {
      moving_.update(moved);
    }
  }

  void ask(FclObject* a, FclObject* b) {
    const double before = result_.min_distance;
    fcl::distance(a, b, request_, result_);
    if (result_.min_distance < before) closest_a_ = a, closest_b_ = b;
  }

  static bool closer(FclObject* a, FclObject* b, void* crowd, double& least) {
    auto& self = *static_cast<FclCrowd*>(crowd);
    const auto object_of = [](const FclObject* o) {
      return static_cast<const Part*>(o->getUserData())->object;
    };
    if (self.watched_[object_of(a) * self.objects_ + object_of(b)]) self.ask(a, b);
    least = self.result_.min_distance;
    return false;
  }

  const std::size_t objects_;
  std::vector<bool> watched_;
  std::vector<Part> parts_;
  std::vector<std::vector<std::size_t>> parts_of_;
  std::vector<Pose> last_;
  Manager moving_, fixed_;
  bool registered_ = false;
  fcl::DistanceRequest<double> request_;
  fcl::DistanceResult<double> result_;
  FclObject *closest_a_ = nullptr, *closest_b_ = nullptr;
};

void time_manager(benchmark::State& state, const MakeCrowd& make, int ticks) {
  const Crowd crowd = make();
  FclCrowd fcl(crowd);
  std::vector<PoseSample> samples;
  std::vector<double> times, minima;
  for (auto _ : state) {
    const std::int64_t now = stamp_ns(static_cast<int>(minima.size()));
    crowd.samples_at(1e-9 * static_cast<double>(now), now, samples);
    const double start = wall_ns();
    minima.push_back(fcl.tick(samples));
    times.push_back(wall_ns() - start);
    state.SetIterationTime(1e-9 * times.back());
  }
  count_times(times, state);
  const std::vector<double> ours = certified_minima(crowd, ticks);
  double max_error = 0.0, compared = 0.0;
  for (std::size_t t = 0; t < ours.size() && t < minima.size(); ++t) {
    if (std::isnan(ours[t])) continue;
    max_error = std::max(max_error, std::abs(minima[t] - ours[t]));
    compared += 1.0;
  }
  state.counters["pairs"] = static_cast<double>(crowd.scene.pairs.size());
  state.counters["max_error"] = max_error;
  state.counters["compared"] = compared;
}

}  // namespace

void register_fcl_manager(const std::string& name, int ticks, const MakeCrowd& make) {
  register_tick_row(name, ticks,
                    [make, ticks](benchmark::State& s) { time_manager(s, make, ticks); });
}

}  // namespace clearance::bench
