// Converts between our structs and the DDS types. Functions that run beside the tick allocate
// nothing: their sequences are sized once.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

#include "config/cell/cell.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/scene_in_force.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "monitor/wire/joint_names.hpp"
#include "monitor/wire/message_fields.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {

// Makes a sample for the reports of this scene, with capacity for its published pairs and for
// kMaxSources sources.
[[nodiscard]] Sample<clearance_msg_Distances> make_distances(const Scene& scene);

// Fills `out`, made by make_distances for the same scene; `publish_ns` 0 when it is not published.
// Returns false when pairs or sources exceed its capacity and are left out. A sample of the same
// scene holds them all.
bool to_wire(const Report& report, std::span<const SourceUse> sources, std::int64_t publish_ns,
             clearance_msg_Distances& out) noexcept;

// State of zone `zone` (an index into Scene::zones and Report::zones). Zone names longer than 64
// bytes are cut; the id is what identifies a zone.
void to_wire(const Scene& scene, const Report& report, std::uint32_t zone,
             clearance_msg_ZoneState& out) noexcept;

// make_separation() makes a sample that can hold the zones with `separation` of any report of this
// scene. to_wire() fills it.
[[nodiscard]] Sample<clearance_msg_Separation> make_separation(const Scene& scene);
void to_wire(const Report& report, std::int64_t publish_ns, clearance_msg_Separation& out) noexcept;

// These convert messages back to reports. They allocate if a list has to grow.
void from_wire(const clearance_msg_Distances& message, Report& out);
void from_wire(const clearance_msg_ZoneState& message, ZoneReport& out);
void from_wire(const clearance_msg_Separation& message, Report& out);

// Names, pairs, zones, joints and the text of the cell, and since when it is in force. It
// allocates. Pairs are those of the scene, as in recordings, or those of the whole cell.
enum class CataloguePairs : std::uint8_t { kOfScene, kOfWholeCell };
[[nodiscard]] Sample<clearance_msg_Catalogue> make_catalogue(
    const Cell& cell, const SceneInForce& since = {},
    CataloguePairs pairs = CataloguePairs::kOfScene);

// Leads from the ids of one list to those of another in every field that means a pair. An id
// without a counterpart stays. For a message of a share's scene: Shares::own_pairs().
class MapPairs {
 public:
  // Without ids, nothing changes.
  explicit MapPairs(std::span<const std::uint32_t> ids) noexcept : ids_(ids) {}

  template <class Message>
  void in(Message& message) const noexcept {
    if (!ids_.empty()) for_each_field(*this, message);
  }

  template <class Value>
  void operator()(const Field& field, Value& value) const noexcept {
    if constexpr (MessageSequence<Value>) {
      if constexpr (HasFields<std::remove_reference_t<decltype(*value._buffer)>>) {
        for (std::uint32_t i = 0; i < value._length; ++i) for_each_field(*this, value._buffer[i]);
      }
    } else if constexpr (HasFields<Value>) {
      for_each_field(*this, value);
    } else if constexpr (std::is_same_v<Value, std::uint32_t>) {
      if (field.meaning == Meaning::kPair && value < ids_.size()) value = ids_[value];
    }
  }

 private:
  std::span<const std::uint32_t> ids_;
};

// Converts a batch for the tick. The poses keep their order and are not checked, because the tick
// refuses unknown ids, non-finite numbers and the rest. Allocates only while the capacity of `out`
// is smaller than the number of poses in the batch.
void from_wire(const clearance_msg_PoseBatch& batch, PoseBatch& out);

// The same for joint states. Names that the cell does not use are left out. Names that it does not
// know become samples of no variable. The tick counts and refuses these, and also positions that
// are missing.
void from_wire(const clearance_msg_JointStates& states, const JointNames& names, PoseBatch& out);

// The same for ROS 2's joint states, which held at `stamp_ns`. Names that the cell does not use or
// does not know are left out, because topics carry the joints of other machines. The result is
// empty when no positions were sent: drivers of grippers send efforts only. If the list of
// positions is too short, the tick refuses the joints without one.
void from_wire(const sensor_msgs_msg_dds__JointState_& states, const JointNames& names,
               std::int64_t stamp_ns, PoseBatch& out);

// Makes the message of a batch of joints. `names` are those of the scene's variables; an id beyond
// them has no name. It allocates.
[[nodiscard]] Sample<clearance_msg_JointStates> make_joint_states(
    const PoseBatch& batch, std::span<const std::string> names);
[[nodiscard]] Sample<clearance_msg_JointStates> make_joint_states(const PoseBatch& batch,
                                                                  const Scene& scene);

// A batch with capacity for `poses` poses, for writing.
[[nodiscard]] Sample<clearance_msg_PoseBatch> make_batch(std::size_t poses);

// One pose of a batch.
void to_wire(const PoseSample& sample, clearance_msg_ObjectPose& out) noexcept;

// Fills `out`, made by make_batch. False: the batch has more poses than its capacity, and only the
// first ones are in.
bool to_wire(const PoseBatch& batch, clearance_msg_PoseBatch& out) noexcept;

}  // namespace clearance
