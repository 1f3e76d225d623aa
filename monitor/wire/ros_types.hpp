// The types of ROS 2 that we read and write: their descriptors, and the hashes by which its tools
// know them.
#pragma once

#include <cstdint>
#include <string>

#include "monitor/wire/dds_sample.hpp"
#include "ros2.h"

namespace clearance {

template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<sensor_msgs_msg_dds__JointState_>() noexcept {
  return sensor_msgs_msg_dds__JointState__desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<std_msgs_msg_dds__String_>() noexcept {
  return std_msgs_msg_dds__String__desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<tf2_msgs_msg_dds__TFMessage_>() noexcept {
  return tf2_msgs_msg_dds__TFMessage__desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<visualization_msgs_msg_dds__MarkerArray_>() noexcept {
  return visualization_msgs_msg_dds__MarkerArray__desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<std_msgs_msg_dds__Float64_>() noexcept {
  return std_msgs_msg_dds__Float64__desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<std_msgs_msg_dds__Bool_>() noexcept {
  return std_msgs_msg_dds__Bool__desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<diagnostic_msgs_msg_dds__DiagnosticArray_>() noexcept {
  return diagnostic_msgs_msg_dds__DiagnosticArray__desc;
}

template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<rosgraph_msgs_msg_dds__Clock_>() noexcept {
  return rosgraph_msgs_msg_dds__Clock__desc;
}

template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<hri_msgs_msg_dds__IdsList_>() noexcept {
  return hri_msgs_msg_dds__IdsList__desc;
}

template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<rcl_interfaces_msg_dds__Log_>() noexcept {
  return rcl_interfaces_msg_dds__Log__desc;
}

template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<rmw_dds_common_msg_dds__ParticipantEntitiesInfo_>() noexcept {
  return rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc;
}

// The delivery of a ROS 2 topic, and what its endpoints say of its type in their USER_DATA (since
// Iron: type description hashes, REP-2011).
struct RosType {
  const dds_topic_descriptor_t* descriptor;
  const char* user_data;
  bool is_latched;     // reliable and transient-local; else the reader takes what comes
  std::int32_t depth;  // samples that may wait, of all writers together: such topics have no keys
  // Samples that a writer keeps. There are few of a state, as in kTopics.
  std::int32_t writer_depth = depth;
  bool is_reliable = is_latched;  // a reader of it is; other readers take what comes
  bool may_be_latched = false;    // some writers keep their last sample for late readers
};

inline constexpr RosType kRosJointState{
    &sensor_msgs_msg_dds__JointState__desc,
    "typehash=RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e;", false, 128,
    4};
inline constexpr RosType kRosString{
    &std_msgs_msg_dds__String__desc,
    "typehash=RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18;", true, 1};
inline constexpr RosType kRosClock{
    &rosgraph_msgs_msg_dds__Clock__desc,
    "typehash=RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564;", false,
    128};
inline constexpr RosType kRosTf{
    &tf2_msgs_msg_dds__TFMessage__desc,
    "typehash=RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087;", false,
    128};
inline constexpr RosType kRosTfStatic{kRosTf.descriptor, kRosTf.user_data, true, 128};
inline constexpr RosType kRosMarkers{
    &visualization_msgs_msg_dds__MarkerArray__desc,
    "typehash=RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf;", false, 10};
inline constexpr RosType kRosDiagnostics{
    &diagnostic_msgs_msg_dds__DiagnosticArray__desc,
    "typehash=RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e;", false, 10};
inline constexpr RosType kRosFloat64{
    &std_msgs_msg_dds__Float64__desc,
    "typehash=RIHS01_705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a;", false, 10};

inline constexpr RosType kRosBool{
    &std_msgs_msg_dds__Bool__desc,
    "typehash=RIHS01_feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9;", false, 16};

inline constexpr RosType kRosIdsList{
    &hri_msgs_msg_dds__IdsList__desc,
    "typehash=RIHS01_7e0812d1ac945c98fd3e393568d581ad0ab567f37b24eff633eab778c1bfe62d;", false, 16};

inline constexpr RosType kRosLog{
    &rcl_interfaces_msg_dds__Log__desc,
    "typehash=RIHS01_e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac;", true,
    1000};

inline constexpr RosType kRosEntities{
    &rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc,
    "typehash=RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e;", true, 1};

// The name of a ROS 2 topic in DDS: "rt/joint_states" is /joint_states.
[[nodiscard]] inline std::string ros_dds_name(const std::string& topic) { return "rt" + topic; }

}  // namespace clearance
