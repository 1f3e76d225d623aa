// Decoders of our own topics of poses and of joint states.
#pragma once

#include <cstddef>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/intake/decoder.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/joint_names.hpp"
#include "monitor/wire/topics.hpp"

namespace clearance {

class OwnPoses final : public Decoder {
 public:
  // `topic` is the name that the cell gives it. Only the first `most` poses of a batch are used.
  OwnPoses(std::string topic, std::size_t most, Outlet& out)
      : topic_(std::move(topic)), most_(most), out_(out) {}
  // Leaves out the poses of objects that the scene does not read.
  OwnPoses(const Scene& scene, std::string topic, std::size_t most, Outlet& out)
      : OwnPoses(std::move(topic), most, out) {
    note_unread(scene);
  }
  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;
  void change(const Cell& cell) override { note_unread(cell.scene); }

 private:
  void note_unread(const Scene& scene);

  std::string topic_;
  std::size_t most_;
  Outlet& out_;
  std::vector<bool> is_unread_;  // by object of the scene `revision_`; empty: all are read
  std::uint64_t revision_ = 0;
  CdrDecoder decoder_;
  Sample<clearance_msg_PoseBatch> message_;
  PoseBatch batch_;
};

class OwnJointStates final : public Decoder {
 public:
  // `topic` is the name that the cell gives it. Only the first `most` joints of a message are used.
  OwnJointStates(const Scene& scene, std::string topic, std::size_t most, Outlet& out)
      : topic_(std::move(topic)), names_(scene), most_(most), out_(out) {}
  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;
  void change(const Cell& cell) override { names_ = JointNames(cell.scene); }

 private:
  static constexpr std::size_t kMostUnknownNames = 64;
  void note_unknown();

  std::string topic_;
  JointNames names_;
  std::set<std::string, std::less<>> unknown_names_;  // that were told
  std::size_t most_;
  Outlet& out_;
  CdrDecoder decoder_;
  Sample<clearance_msg_JointStates> message_;
  PoseBatch batch_;
};

// Decodes both topics for recordings and viewers: each batch as it was sent, from any sender.
class OwnBatches final : private Outlet {
 public:
  explicit OwnBatches(const Scene& scene)
      : poses_("", kAll, *this), joint_states_(scene, "", kAll, *this) {}
  OwnBatches(const OwnBatches&) = delete;
  OwnBatches& operator=(const OwnBatches&) = delete;

  // Decodes a message of poses or joint states. The batch is valid until the next call and may be
  // moved from. Returns null if the bytes do not decode.
  [[nodiscard]] PoseBatch* decode(TopicKind kind, std::span<const std::byte> cdr);

 private:
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  void give(PoseBatch& batch, std::uint64_t, std::size_t) override { given_ = &batch; }
  void tell(News) override {}

  OwnPoses poses_;
  OwnJointStates joint_states_;
  PoseBatch* given_ = nullptr;
};

}  // namespace clearance
