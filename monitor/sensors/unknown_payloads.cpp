#include "monitor/sensors/unknown_payloads.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace clearance {
namespace {

// Between pictures that count, m; at least so many of these count.
constexpr double kStep = 2.0 * PayloadGrid::kCell;
constexpr std::uint32_t kLeastPictures = 5;
// A rotation moves what is held by this times its angle, m.
constexpr double kArm = 0.1;
// Between the postures of the pictures that show what was free, m.
constexpr double kApart = 0.2;
// What is held begins within this of the ball around the link's parts, m: its own image is left out
// with a shell, and fingers may be between.
constexpr double kBeside = 0.15;
// What stands still leaves its cell and those beside it when the link has moved by this, m.
constexpr double kSpread = 0.08;
// No point of the grid is farther from its middle, m.
constexpr double kReach = 1.7320509 * PayloadGrid::kHalf;

double motion(const Pose& from, const Pose& to, const Vec3& middle) noexcept {
  return (transform(to, middle) - transform(from, middle)).norm() +
         kArm * from.orientation.angularDistance(to.orientation);
}

bool is_joint_of_fingers(const Robot& robot, const RobotJoint& joint) {
  return joint.type != JointType::kFixed &&
         std::ranges::count_if(robot.joints, [&](const RobotJoint& each) {
           return each.type != JointType::kFixed && each.variable == joint.variable;
         }) > 1;
}

// What carries the fingers that this link is part of; the link itself, if it is no finger.
std::uint32_t hand_of(const Robot& robot, std::uint32_t link) {
  std::uint32_t hand = link;
  for (std::uint32_t at = link; at > 0; at = robot.joints[at - 1].parent)
    if (is_joint_of_fingers(robot, robot.joints[at - 1])) hand = robot.joints[at - 1].parent;
  return hand;
}

// The links with shapes that no other link with a shape hangs on.
std::vector<std::uint32_t> ends_of(const Robot& robot) {
  std::vector<bool> carries(robot.links.size());
  std::vector<std::uint32_t> ends;
  for (auto link = static_cast<std::uint32_t>(robot.links.size()); link-- > 0;) {
    const bool has_shape = robot.links[link].object != RobotLink::kNoObject;
    if (has_shape && !carries[link]) ends.push_back(link);
    if (link > 0 && (has_shape || carries[link])) carries[robot.joints[link - 1].parent] = true;
  }
  return ends;
}

}  // namespace

std::vector<UnknownPayload> hands_of(const Scene& scene) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> hands, bases;
  for (const Robot& robot : scene.robots) {
    if (robot.base.kind != RobotBase::Kind::kLink) continue;
    const std::pair on(robot.base.robot, robot.base.link);
    (robot.is_attached && !scene.robots[on.first].is_attached ? hands : bases).insert(on);
  }
  for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
    if (scene.robots[r].is_attached) continue;
    for (const std::uint32_t end : ends_of(scene.robots[r])) {
      const std::pair hand(r, hand_of(scene.robots[r], end));
      if (!bases.contains(hand)) hands.insert(hand);
    }
  }
  std::vector<UnknownPayload> found;
  for (const auto& [robot, link] : hands)
    if (robot < kMostRobotsSeen) found.push_back({.robot = robot, .link = link, .box = {}});
  return found;
}

UnknownPayloads::UnknownPayloads(const Scene& scene, const Sensor& sensor)
    : scene_(scene),
      sensor_(sensor),
      pictures_(std::clamp(sensor.witness_frames, kLeastPictures, PayloadGrid::kMostPictures)),
      now_(sensor.columns, sensor.rows),
      payloads_(hands_of(scene)) {
  std::set<std::uint32_t> links;
  for (const Robot& robot : scene.robots)
    for (const RobotLink& link : robot.links) links.insert(link.object);
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (!object.fixed && !object.is_seen() && !links.contains(i)) tracked_.push_back(i);
  }
  for (const UnknownPayload& payload : payloads_) {
    Hand& hand = hands_.emplace_back(pictures_, now_);
    hand.reach = kBeside;
    const std::uint32_t object = scene.robots[payload.robot].links[payload.link].object;
    if (object == RobotLink::kNoObject) continue;
    const std::vector<Part>& parts = scene.objects[object].parts;
    for (const Part& part : parts)
      hand.middle += part.object_from_part.position / static_cast<double>(parts.size());
    for (const Part& part : parts) {
      const double radius = part.shape.bounding_radius + part.shape.radius;
      const double to_middle = (part.object_from_part.position - hand.middle).norm();
      hand.reach = std::max(hand.reach, to_middle + radius + kBeside);
    }
  }
}

void UnknownPayloads::note(const DepthCloud& picture, const PinholeCamera& camera,
                           const PastPose& place) noexcept {
  camera_ = camera;
  now_.set(picture, camera, place.world_from_body);
}

// Of a tile that is smaller than half a cell, one pixel stands for all.
void UnknownPayloads::fill(Hand& hand, const DepthCloud& cloud, const PastPose& place,
                           const Pose& world_from_grid) const noexcept {
  const RelativePose grid_from_camera = relative_pose(world_from_grid, place.world_from_body);
  const Vec3 middle = relative_pose(place.world_from_body, world_from_grid).translation;
  const double nearest = middle.z() - kReach, farthest = middle.z() + kReach;
  for (std::size_t i = 0; i < cloud.blocks(); ++i) {
    const DepthCloud::Node tile = cloud.node(0, i);
    if (DepthCloud::is_empty(tile) || tile.high < nearest || tile.low > farthest) continue;
    const bool is_fine = 4.0 * tile.low < 0.5 * PayloadGrid::kCell * camera_.fx;
    const DepthCloud::Block& block = cloud.block(i);
    for (std::size_t lane = 0; lane < DepthCloud::kFanOut; ++lane) {
      if (block.low[lane] > block.high[lane]) continue;
      const Vec3 in_camera = cloud.pixel_slab(i, lane).middle();
      const Vec3 in_grid = grid_from_camera.rotation * in_camera + grid_from_camera.translation;
      if ((in_grid.array().abs() < PayloadGrid::kHalf).all()) {
        const Vec3 in_world = transform(world_from_grid, in_grid);
        const bool came = std::ranges::any_of(hand.before, [&](const TileDepths& each) {
          return each.at(in_world, PayloadGrid::kCell) == TileDepths::Sight::kFree;
        });
        hand.grid.add(in_grid, came);
      }
      if (is_fine) break;
    }
  }
}

// Cells that something nearer hides say nothing. Of the others, hardly any has an element.
bool UnknownPayloads::is_gone(const Hand& hand, const Pose& world_from_grid) const noexcept {
  std::size_t open = 0, there = 0;
  for (const std::uint16_t cell : hand.grid.cells()) {
    const Vec3 at = transform(world_from_grid, PayloadGrid::middle_of(cell));
    const TileDepths::Sight sight = now_.at(at, PayloadGrid::kCell);
    if (sight == TileDepths::Sight::kUnseen || sight == TileDepths::Sight::kHidden) continue;
    ++open;
    if (hand.grid.has(cell)) ++there;
  }
  return 2 * open >= hand.grid.cells().size() && 5 * there < open;
}

// True within the ball around a part of an object whose poses come.
bool UnknownPayloads::is_known(const Vec3& place, const PostureHistory& postures) const noexcept {
  return std::ranges::any_of(tracked_, [&](std::uint32_t i) {
    const PastPose past = postures.object(i);
    if (!past.known) return false;
    return std::ranges::any_of(scene_.objects[i].parts, [&](const Part& part) {
      const Vec3 centre = transform(past.world_from_body, part.object_from_part.position);
      return (place - centre).norm() <=
             part.shape.bounding_radius + part.shape.radius + PayloadGrid::kCell;
    });
  });
}

void UnknownPayloads::look(const DepthCloud& cloud, const PastPose& place,
                           const PostureHistory& postures, const RobotsSeen& robots,
                           std::int64_t stamp_ns) noexcept {
  const DepthError error{sensor_.error_constant, sensor_.error_quadratic};
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    Hand& hand = hands_[i];
    UnknownPayload& payload = payloads_[i];
    if ((robots.there >> payload.robot & 1U) == 0) continue;
    const PastPose past = postures.link(payload.robot, payload.link);
    if (!past.known) continue;
    Pose world_from_grid = past.world_from_body;
    world_from_grid.position = transform(past.world_from_body, hand.middle);
    const Vec3 seen = relative_pose(place.world_from_body, world_from_grid).translation;
    const double off = past.error(hand.middle.norm() + kReach) + place.error(seen.norm());
    if (!(seen.z() > 0.0 && error.at(seen.z()) + off < PayloadGrid::kCell)) continue;
    hand.grid.begin();
    fill(hand, cloud, place, world_from_grid);
    if (payload.is_held) {
      hand.missing = is_gone(hand, world_from_grid) ? hand.missing + 1 : 0;
      if (hand.missing >= pictures_) {
        payload.is_held = false;
        hand.grid.clear();
        hand.count = hand.missing = 0;
      }
    }
    look(hand, payload, past.world_from_body, postures, stamp_ns);
  }
}

// False if something that stands at one place of the world may be at this place in the frame of the
// link in nearly all counted pictures.
bool UnknownPayloads::has_moved(const Hand& hand, const Vec3& place) const noexcept {
  const auto at = [&](std::uint32_t picture) {
    return transform(hand.counted[picture].world_from_link, place);
  };
  for (std::uint32_t i = 0; i < pictures_; ++i) {
    std::uint32_t near = 0;
    for (std::uint32_t k = 0; k < pictures_; ++k)
      if ((at(k) - at(i)).norm() < kSpread) ++near;
    if (PayloadGrid::is_nearly_all(near, pictures_)) return false;
  }
  return true;
}

// Counts the picture if the link has moved, and finds what it holds.
void UnknownPayloads::look(Hand& hand, UnknownPayload& payload, const Pose& world_from_link,
                           const PostureHistory& postures, std::int64_t stamp_ns) noexcept {
  const bool is_first = hand.count == 0;
  if (is_first || motion(hand.noted, world_from_link, hand.middle) > kApart) {
    std::swap(hand.before[0], hand.before[1]);
    hand.before[0] = now_;
    hand.noted = world_from_link;
  }
  if (!is_first &&
      motion(hand.counted.front().world_from_link, world_from_link, hand.middle) < kStep)
    return;
  hand.grid.count();
  hand.count = std::min(hand.count + 1, pictures_);
  std::shift_right(hand.counted.begin(), hand.counted.end(), 1);
  hand.counted.front() = {stamp_ns, world_from_link};
  if (payload.is_held || !hand.grid.is_full()) return;
  auto found = hand.grid.find(hand.reach);
  if (!found) return;
  Pose world_from_grid = world_from_link;
  world_from_grid.position = transform(world_from_link, hand.middle);
  if (is_known(transform(world_from_grid, found->centre), postures)) return;
  found->centre += hand.middle;
  if (!has_moved(hand, found->centre)) return;
  payload = {.robot = payload.robot,
             .link = payload.link,
             .is_held = true,
             .since_ns = hand.counted[pictures_ - 1].stamp_ns,
             .box = *found};
}

}  // namespace clearance
