// Reports go by the lists of monitor/interface/report_fields.hpp; inputs and the catalogue field by
// field. Functions for the tick thread and beside it write into sequences that make_distances or
// make_batch sized.
#include "monitor/wire/convert.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "monitor/files/build_info.hpp"
#include "monitor/wire/from_wire.hpp"
#include "monitor/wire/to_wire.hpp"
#include "monitor/wire/two_values.hpp"

namespace clearance {
namespace {

clearance_msg_Vector3 to_wire(const Vec3& v) noexcept { return {v.x(), v.y(), v.z()}; }

// Numbers are passed on as they are: the tick refuses those that are not finite.
Vec3 from_wire(const clearance_msg_Vector3& v) noexcept { return {v.x, v.y, v.z}; }

// Into a bounded string, cut to fit; the rest is zeroed so that equal names are equal bytes.
template <std::size_t N>
void copy_text(std::string_view text, char (&out)[N]) noexcept {
  const std::size_t length = std::min(text.size(), N - 1);
  std::memcpy(out, text.data(), length);
  std::memset(out + length, 0, N - length);
}

// Strings of a sample are freed by Cyclone, so they are allocated by it.
char* duplicate(const std::string& text) { return dds_string_dup(text.c_str()); }

// Part names in their order: a part id is a place in it.
void fill(const Object& object, std::uint32_t id, clearance_msg_CatalogueObject& out) {
  out.id = id;
  out.name = duplicate(object.name);
  out.is_fixed = object.fixed;
  reserve_sequence(out.parts, object.parts.size());
  for (const Part& part : object.parts)
    out.parts._buffer[out.parts._length++] = duplicate(part.name);
}

// An end that is not stated is infinite or 0.
void fill(const AllowedContact& contact, std::uint32_t id, clearance_msg_CatalogueContact& out) {
  out.id = id;
  out.name = duplicate(contact.name);
  out.group_a = duplicate(contact.group_a);
  out.group_b = duplicate(contact.group_b);
  out.depth = contact.depth;
  out.end_distance = contact.end.distance;
  out.end_duration_ns =
      contact.end.duration_ns == ContactEnd::kNoTime ? -1 : contact.end.duration_ns;
  out.end_time_ns = contact.end.time_ns == ContactEnd::kNoTime ? 0 : contact.end.time_ns;
  out.last_cycle = contact.end.last_cycle == ContactEnd::kNoCycle ? 0 : contact.end.last_cycle;
  out.by = duplicate(contact.by);
  out.reason = duplicate(contact.reason);
}

// Thresholds in m, as in the scene.
void fill(const Zone& zone, std::uint32_t id, clearance_msg_CatalogueZone& out) {
  out.id = id;
  out.name = duplicate(zone.name);
  out.group_a = duplicate(zone.group_a);
  out.group_b = duplicate(zone.group_b);
  out.enter_below = zone.enter_below;
  out.leave_above = zone.leave_above;
}

void fill_separated(const Cell& cell, clearance_msg_Catalogue& out) {
  reserve_sequence(out.separated_zones, cell.scene.zones.size());
  const auto add = [&](std::uint32_t zone) {
    out.separated_zones._buffer[out.separated_zones._length++] = zone;
  };
  if (cell.shares.is_one()) {
    std::ranges::for_each(cell.shares.separated, add);
  } else {
    for (std::uint32_t zone = 0; zone < cell.scene.zones.size(); ++zone) {
      if (cell.scene.zones[zone].separation) add(zone);
    }
  }
}

void fill_stopping(const Scene& scene, clearance_msg_Catalogue& out) {
  reserve_sequence(out.stopping_robots, scene.robots.size());
  for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
    if (!scene.robots[robot].stopping.is_stated()) continue;
    out.stopping_robots._buffer[out.stopping_robots._length++] = robot;
  }
}

// The index of a share fits into an octet.
void fill_shares(const Shares& shares, bool with_pairs, clearance_msg_Catalogue& out) {
  copy_text(shares.name(), out.share);
  reserve_sequence(out.shares, shares.all.size());
  std::size_t pairs = 0;
  for (const Share& share : shares.all) {
    clearance_msg_CatalogueShare& to = out.shares._buffer[out.shares._length++];
    copy_text(share.name, to.name);
    to.pairs_total = static_cast<std::uint32_t>(share.pairs.size());
    reserve_sequence(to.zones, share.zones.size());
    for (const std::uint32_t zone : share.zones) to.zones._buffer[to.zones._length++] = zone;
    pairs += share.pairs.size();
  }
  if (!with_pairs) return;
  reserve_sequence(out.pair_shares, pairs);
  out.pair_shares._length = static_cast<std::uint32_t>(pairs);
  for (std::size_t share = 0; share < shares.all.size(); ++share) {
    for (const std::uint32_t pair : shares.all[share].pairs)
      out.pair_shares._buffer[pair] = static_cast<std::uint8_t>(share);
  }
}

}  // namespace

// Sequences get the capacity that any report of this scene needs.
Sample<clearance_msg_Distances> make_distances(const Scene& scene) {
  const auto published = std::count_if(scene.pairs.begin(), scene.pairs.end(),
                                       [](const ObjectPair& pair) { return pair.publish; });
  Sample<clearance_msg_Distances> sample;
  reserve_sequence(sample->pairs, static_cast<std::size_t>(published));
  reserve_sequence(sample->sources, clearance_msg_kMaxSources);
  reserve_sequence(sample->source_contents, clearance_msg_kMaxSources);
  reserve_sequence(sample->contacts, contact_pairs(scene).size());
  reserve_sequence(sample->hidden, hidden_pairs(scene).size());
  reserve_sequence(sample->active_zones, scene.zones.size());
  return sample;
}

bool to_wire(const Report& report, std::span<const SourceUse> sources, std::int64_t publish_ns,
             clearance_msg_Distances& out) noexcept {
  DistanceFields::for_each(ToWire{}, report, out);
  out.publish_ns = publish_ns;
  out.sources._length =
      static_cast<std::uint32_t>(std::min<std::size_t>(sources.size(), out.sources._maximum));
  for (std::uint32_t i = 0; i < out.sources._length; ++i) {
    copy_text(sources[i].source.view(), out.sources._buffer[i].source);
    out.sources._buffer[i].sequence_number = sources[i].sequence_number;
  }
  out.source_contents._length = std::min(out.sources._length, out.source_contents._maximum);
  for (std::uint32_t i = 0; i < out.source_contents._length; ++i)
    out.source_contents._buffer[i] = sources[i].content;
  auto& active = out.active_zones;
  active._length = 0;
  for (std::uint32_t zone = 0; zone < report.zones.size(); ++zone) {
    if (report.zones[zone].active && active._length < active._maximum)
      active._buffer[active._length++] = zone;
  }
  return out.sources._length == sources.size() && out.pairs._length == report.pairs.size();
}

void to_wire(const Scene& scene, const Report& report, std::uint32_t zone,
             clearance_msg_ZoneState& out) noexcept {
  PublishedZoneFields::for_each(ToWire{}, report.zones[zone], out);
  out.zone = zone;
  copy_text(scene.zones[zone].name, out.name);
  out.cycle = report.cycle;
  out.now_ns = report.now_ns;
}

Sample<clearance_msg_Separation> make_separation(const Scene& scene) {
  const SeparatedCount count = separated_count(scene);
  Sample<clearance_msg_Separation> sample;
  reserve_sequence(sample->zones, count.zones);
  reserve_sequence(sample->pairs, count.pairs);
  reserve_sequence(sample->stops, count.stops);
  return sample;
}

void to_wire(const Report& report, std::int64_t publish_ns,
             clearance_msg_Separation& out) noexcept {
  constexpr ToWire kToWire;
  TickFields::for_each(kToWire, report, out);
  out.publish_ns = publish_ns;
  kToWire(Field{"pairs"}, report.separated_pairs, out.pairs);
  kToWire(Field{"zones"}, report.separated_zones, out.zones);
  kToWire(Field{"stops"}, report.stops, out.stops);
}

void from_wire(const clearance_msg_Distances& message, Report& out) {
  DistanceFields::for_each(FromWire{}, message, out);
}

void from_wire(const clearance_msg_ZoneState& message, ZoneReport& out) {
  PublishedZoneFields::for_each(FromWire{}, message, out);
}

void from_wire(const clearance_msg_Separation& message, Report& out) {
  constexpr FromWire kFromWire;
  kFromWire(Field{"pairs"}, message.pairs, out.separated_pairs);
  kFromWire(Field{"zones"}, message.zones, out.separated_zones);
  kFromWire(Field{"stops"}, message.stops, out.stops);
}

// Ids are places in the lists, as in the scene.
Sample<clearance_msg_Catalogue> make_catalogue(const Cell& cell, const SceneInForce& since,
                                               CataloguePairs of) {
  const Scene& scene = cell.scene;
  Sample<clearance_msg_Catalogue> sample;
  sample->scene = duplicate(scene.name);
  sample->scene_revision = scene.revision;
  sample->rate_hz = scene.rate_hz;
  sample->cell_yaml = duplicate(cell.yaml);
  sample->cell_hash = duplicate(cell.hash);
  sample->build = duplicate(kBuild);
  sample->began_after = since.began_after;
  sample->in_force_from = since.from;
  reserve_sequence(sample->objects, scene.objects.size());
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    fill(scene.objects[i], i, sample->objects._buffer[sample->objects._length++]);
  }
  const bool of_whole = of == CataloguePairs::kOfWholeCell || !cell.shares.is_one();
  const std::vector<ObjectPair>& pairs =
      of_whole && cell.shares.is_one() ? cell.shares.pairs : scene.pairs;
  fill_shares(cell.shares, of_whole && !cell.shares.all.empty(), *sample);
  reserve_sequence(sample->pairs, pairs.size());
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    const ObjectPair& pair = pairs[i];
    sample->pairs._buffer[sample->pairs._length++] = {i, pair.first, pair.second, pair.publish};
  }
  reserve_sequence(sample->zones, scene.zones.size());
  for (std::uint32_t i = 0; i < scene.zones.size(); ++i) {
    fill(scene.zones[i], i, sample->zones._buffer[sample->zones._length++]);
  }
  fill_separated(cell, *sample);
  fill_stopping(scene, *sample);
  reserve_sequence(sample->joints, scene.variables.size());
  for (std::uint32_t i = 0; i < scene.variables.size(); ++i) {
    sample->joints._buffer[sample->joints._length++] = {i, duplicate(scene.variables[i].name)};
  }
  reserve_sequence(sample->robots, scene.robots.size());
  for (const Robot& robot : scene.robots)
    sample->robots._buffer[sample->robots._length++] = duplicate(robot.name);
  reserve_sequence(sample->contacts, scene.contacts.size());
  for (std::uint32_t i = 0; i < scene.contacts.size(); ++i) {
    fill(scene.contacts[i], i, sample->contacts._buffer[sample->contacts._length++]);
  }
  return sample;
}

namespace {

void refuse_two_positions(std::vector<JointSample>& joints) {
  // Names that no robot has, or several, stay as they are.
  const auto known = [](const JointSample& sample) {
    return sample.variable < JointNames::kUnused;
  };
  refuse_two_values(
      joints, [](const JointSample& sample) { return sample.variable; },
      [&](const JointSample& a, const JointSample& b) { return !known(a) || say_the_same(a, b); },
      [](JointSample& sample) { sample.position = std::numeric_limits<double>::quiet_NaN(); });
}

void refuse_two_poses(std::vector<PoseSample>& poses) {
  refuse_two_values(
      poses, [](const PoseSample& sample) { return std::pair(sample.object, sample.stamp_ns); },
      [](const PoseSample& a, const PoseSample& b) { return say_the_same(a, b); },
      [](PoseSample& sample) {
        sample.world_from_object.position.setConstant(std::numeric_limits<double>::quiet_NaN());
      });
}

}  // namespace

// Quaternions are x, y, z, w on the wire.
void from_wire(const clearance_msg_PoseBatch& batch, PoseBatch& out) {
  out.source = SourceName(batch.source);
  out.sequence_number = batch.sequence_number;
  out.scene_revision = batch.scene_revision;
  out.joints.clear();
  out.samples.resize(batch.poses._length);
  for (std::uint32_t i = 0; i < batch.poses._length; ++i) {
    const clearance_msg_ObjectPose& pose = batch.poses._buffer[i];
    PoseSample& sample = out.samples[i];
    sample.object = pose.object;
    sample.stamp_ns = pose.stamp_ns;
    sample.world_from_object.position = from_wire(pose.position);
    sample.world_from_object.orientation.coeffs() << pose.orientation.x, pose.orientation.y,
        pose.orientation.z, pose.orientation.w;
    sample.has_twist = pose.has_twist;
    sample.twist.linear = from_wire(pose.linear);
    sample.twist.angular = from_wire(pose.angular);
  }
  refuse_two_poses(out.samples);
}

void from_wire(const clearance_msg_JointStates& states, const JointNames& names, PoseBatch& out) {
  out.source = SourceName(states.source);
  out.sequence_number = states.sequence_number;
  out.scene_revision = 0;
  out.samples.clear();
  out.joints.clear();
  const bool has_velocities =
      states.velocities._length > 0 && states.velocities._length == states.names._length;
  for (std::uint32_t i = 0; i < states.names._length; ++i) {
    const std::uint32_t variable = names.find(states.names._buffer[i]);
    if (variable == JointNames::kUnused) continue;
    JointSample& sample = out.joints.emplace_back();
    sample.variable = variable;
    sample.stamp_ns = states.stamp_ns;
    sample.stopping = states.stopping;
    sample.position = i < states.positions._length ? states.positions._buffer[i]
                                                   : std::numeric_limits<double>::quiet_NaN();
    sample.has_velocity = has_velocities;
    if (has_velocities) sample.velocity = states.velocities._buffer[i];
  }
  refuse_two_positions(out.joints);
}

void from_wire(const sensor_msgs_msg_dds__JointState_& states, const JointNames& names,
               std::int64_t stamp_ns, PoseBatch& out) {
  out.scene_revision = 0;
  out.samples.clear();
  out.joints.clear();
  if (states.position._length == 0) return;
  const bool has_velocities =
      states.velocity._length > 0 && states.velocity._length == states.name._length;
  for (std::uint32_t i = 0; i < states.name._length; ++i) {
    const std::uint32_t variable = names.find(states.name._buffer[i]);
    if (variable >= JointNames::kUnused) continue;
    JointSample& sample = out.joints.emplace_back();
    sample.variable = variable;
    sample.stamp_ns = stamp_ns;
    sample.position = i < states.position._length ? states.position._buffer[i]
                                                  : std::numeric_limits<double>::quiet_NaN();
    sample.has_velocity = has_velocities;
    if (has_velocities) sample.velocity = states.velocity._buffer[i];
  }
  refuse_two_positions(out.joints);
}

// All samples of a batch have one stamp. All or none have a velocity, and all or none are stopping.
Sample<clearance_msg_JointStates> make_joint_states(const PoseBatch& batch,
                                                    std::span<const std::string> names) {
  Sample<clearance_msg_JointStates> states;
  copy_text(batch.source.view(), states->source);
  states->sequence_number = batch.sequence_number;
  if (batch.joints.empty()) return states;
  states->stamp_ns = batch.joints.front().stamp_ns;
  states->stopping = batch.joints.front().stopping;
  const bool has_velocities = batch.joints.front().has_velocity;
  reserve_sequence(states->names, batch.joints.size());
  reserve_sequence(states->positions, batch.joints.size());
  if (has_velocities) reserve_sequence(states->velocities, batch.joints.size());
  for (const JointSample& sample : batch.joints) {
    const bool known = sample.variable < names.size();
    states->names._buffer[states->names._length++] = duplicate(known ? names[sample.variable] : "");
    states->positions._buffer[states->positions._length++] = sample.position;
    if (has_velocities) states->velocities._buffer[states->velocities._length++] = sample.velocity;
  }
  return states;
}

Sample<clearance_msg_JointStates> make_joint_states(const PoseBatch& batch, const Scene& scene) {
  std::vector<std::string> names;
  for (const JointVariable& variable : scene.variables) names.push_back(variable.name);
  return make_joint_states(batch, names);
}

// The sequence keeps its buffer from batch to batch.
Sample<clearance_msg_PoseBatch> make_batch(std::size_t poses) {
  Sample<clearance_msg_PoseBatch> sample;
  reserve_sequence(sample->poses, poses);
  return sample;
}

void to_wire(const PoseSample& sample, clearance_msg_ObjectPose& out) noexcept {
  const Eigen::Quaterniond& q = sample.world_from_object.orientation;
  out.object = sample.object;
  out.stamp_ns = sample.stamp_ns;
  out.position = to_wire(sample.world_from_object.position);
  out.orientation = {q.x(), q.y(), q.z(), q.w()};
  out.has_twist = sample.has_twist;
  out.linear = to_wire(sample.twist.linear);
  out.angular = to_wire(sample.twist.angular);
}

bool to_wire(const PoseBatch& batch, clearance_msg_PoseBatch& out) noexcept {
  copy_text(batch.source.view(), out.source);
  out.sequence_number = batch.sequence_number;
  out.scene_revision = batch.scene_revision;
  out.poses._length =
      static_cast<std::uint32_t>(std::min<std::size_t>(batch.samples.size(), out.poses._maximum));
  for (std::uint32_t i = 0; i < out.poses._length; ++i) {
    to_wire(batch.samples[i], out.poses._buffer[i]);
  }
  return out.poses._length == batch.samples.size();
}

}  // namespace clearance
