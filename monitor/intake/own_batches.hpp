// Our own topics of poses and of joint states.
#pragma once

#include <cstddef>

#include "config/scene/scene.hpp"
#include "monitor/intake/decoder.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/joint_names.hpp"

namespace clearance {

class OwnPoses final : public Decoder {
 public:
  // Of a batch the first `most` poses are used.
  OwnPoses(const Scene& scene, std::size_t most, Outlet& out)
      : scene_(scene), most_(most), out_(out) {}
  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;

 private:
  const Scene& scene_;
  std::size_t most_;
  Outlet& out_;
  CdrDecoder decoder_;
  Sample<clearance_msg_PoseBatch> message_;
  PoseBatch batch_;
};

class OwnJointStates final : public Decoder {
 public:
  // Of a message the first `most` joints are used.
  OwnJointStates(const Scene& scene, std::size_t most, Outlet& out)
      : scene_(scene), names_(scene), most_(most), out_(out) {}
  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;

 private:
  const Scene& scene_;
  JointNames names_;
  std::size_t most_;
  Outlet& out_;
  CdrDecoder decoder_;
  Sample<clearance_msg_JointStates> message_;
  PoseBatch batch_;
};

}  // namespace clearance
