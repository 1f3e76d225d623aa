// The topics of std_msgs/msg/Bool on which robots state that their brakes act, and do so until they
// stand. Joint states of ROS 2 have no field for it: `stopping` of JointSample follows from both.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/intake/decoder.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

class StatedStops final : public Decoder {
 public:
  // The scene and the outlet must outlive this.
  StatedStops(const Scene& scene, Outlet& out) : scene_(&scene), out_(out) {}

  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] std::vector<NamedTopic> named() const override;
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;
  void keep(std::span<const std::uint64_t> writers) override;
  void change(const Cell& cell) override { scene_ = &cell.scene; }

  // True if the brakes of the variable's robot act since `stamp_ns` or before, by a message that is
  // now no older than the age limit of the variable. Each writer that is heard says so.
  [[nodiscard]] bool is_stopping(std::uint32_t variable, std::int64_t stamp_ns,
                                 const Now& now) const;

 private:
  struct Statement {
    bool is_stopping = false;
    std::int64_t since_ns = 0, last_ns = 0;  // times of sending, no later than of arrival
  };
  struct Topic {
    std::string name;
    std::map<std::uint64_t, Statement> of_writers;
  };
  [[nodiscard]] bool is_named(const std::string& topic) const;
  // The least age limit of the robots that name the topic.
  [[nodiscard]] std::int64_t age_limit_ns(const std::string& topic) const;

  const Scene* scene_;
  Outlet& out_;
  std::vector<Topic> topics_;  // by port
  CdrDecoder decoder_;
  Sample<std_msgs_msg_dds__Bool_> message_;
};

}  // namespace clearance
