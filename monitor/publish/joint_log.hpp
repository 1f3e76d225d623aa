// Logs the news of each robot's joints: late, contradicted, sent twice, heard, or never heard. All
// joints of a robot that change together share one line.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// The most inputs that one line names.
inline constexpr std::size_t kNamesALine = 3;

class JointLog {
 public:
  // After this number of samples (seconds), the log names the joints that were never heard.
  static constexpr int kSilentSamples = 5;

  // The scene must outlive this, or its use until the next call of change().
  explicit JointLog(const Scene& scene) : scene_(&scene) {}
  // The following samples are of this scene. Robots and joints are known by their names.
  void change(const Scene& scene);

  // Called with the joints of every health sample, in order. `senders` names the senders of joint
  // states.
  void update(const decltype(clearance_msg_Health::joints)& joints,
              const std::function<std::string()>& senders);

 private:
  enum class State : std::uint8_t { kUnseen, kFine, kLate, kContradicted };
  using Names = std::vector<std::string>;

  void update_robot(std::uint32_t robot, const decltype(clearance_msg_Health::joints)& joints,
                    const std::function<std::string()>& senders);
  void log_change(const std::string& robot, State before, State now, const Names& names,
                  std::int64_t age_ns) const;

  struct Joint {
    State state = State::kUnseen;
    std::string other_source;  // the other source that sends it
  };
  struct RobotOfLog {
    int samples = 0;
    bool silence_said = false;
  };

  const Scene* scene_;
  std::map<std::string, Joint> joints_;
  std::map<std::string, RobotOfLog> robots_;
};

}  // namespace clearance
