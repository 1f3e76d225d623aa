// The checksum by which partners find that their states differ. Each tick has all poses, and a
// slice of everything else: of pairs, and of what is known of objects and parts beside their poses.
//
// A list of fields is not complete by itself. tests/monitor/loop/flipped_bits_test.cpp flips
// bits of every field.
#include "monitor/inputs/checksum.hpp"
#include "monitor/tick/monitor_state.hpp"

namespace clearance {
namespace {

void add_sphere(const Sphere& sphere, Checksum& sum) noexcept {
  sum.add3(sphere.centre);
  sum.add(sphere.radius);
}

void add_object(const TrackedObject& object, Checksum& sum) noexcept {
  for (const bool flag :
       {object.moved, object.newly_known, object.discontinuous, object.plain, object.absent,
        object.twist_known, object.follows_joints, object.joints_late, object.joints_contradicted,
        object.rest.holds, object.rest.has_twist, object.input.has_value, object.input.late,
        object.input.contradicted, object.input.ages, object.pose_last_tick_known}) {
    sum.add(flag);
  }
  for (const double value :
       {object.may_have_moved, object.unobserved, object.displacement, object.accumulated_last_tick,
        object.bend, object.accumulated_turn, object.bounding_radius, object.motion.shift,
        object.motion.turn, object.unobserved_by_joints}) {
    sum.add(value);
  }
  sum.add(object.rest.until_ns);
  sum.add_pose(object.pose_last_tick);
  sum.add_pose(object.pose_before);
}

void add_part(const PosedPart& part, Checksum& sum) noexcept {
  sum.add(part.object);
  sum.add(part.index_in_object);
  sum.add(part.placed);
  sum.add(part.keeps_direction);
  for (const double value :
       {part.shift_error, part.turn_error, part.turning, part.coordinates, part.bounding_radius,
        part.extent, part.offset_length, part.sphere_offset}) {
    sum.add(value);
  }
  add_sphere(part.sphere_in_world, sum);
  add_sphere(part.sphere_in_part, sum);
  sum.add_pose(part.object_from_part);
  for (int column = 0; column < 3; ++column) sum.add3(part.world_from_part_rotation.col(column));
}

}  // namespace

std::uint64_t Monitor::checksum() const noexcept {
  const State& s = *state_;
  Checksum sum;
  for (const TrackedObject& object : s.inputs.objects) {
    sum.add_pose(object.pose);
    sum.add3(object.twist.linear);
    sum.add3(object.twist.angular);
    sum.add(object.accumulated);
    sum.add(object.input.stamp_ns);
  }
  for (const PosedPart& part : s.parts) sum.add_pose(part.world_from_part);
  const auto each_of_slice = [slice = s.inputs.cycle % kStateSlices](std::uint64_t count,
                                                                     const auto& add) {
    for (std::uint64_t i = count * slice / kStateSlices; i < count * (slice + 1) / kStateSlices;
         ++i)
      add(i);
  };
  each_of_slice(s.inputs.objects.size(), [&](auto i) { add_object(s.inputs.objects[i], sum); });
  each_of_slice(s.parts.size(), [&](auto i) { add_part(s.parts[i], sum); });
  each_of_slice(s.table.pairs(),
                [&](auto i) { add_pair(static_cast<std::uint32_t>(i), s.table, sum); });
  return sum.value();
}

}  // namespace clearance
