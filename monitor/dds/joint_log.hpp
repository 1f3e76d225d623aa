// What a person should know of the joints of each robot: late, contradicted, sent twice, heard, or
// not heard at all. One line for all joints of a robot that change together.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

class JointLog {
 public:
  // Of joints that nothing has come of, samples (seconds) after which the log says so.
  static constexpr int kSilentSamples = 5;

  // The scene must outlive this.
  explicit JointLog(const Scene& scene);

  // To be called with the joints of every health sample, in order. `senders` says who sends joint
  // states at all.
  void update(const decltype(clearance_msg_Health::joints)& joints,
              const std::function<std::string()>& senders);

 private:
  enum class State : std::uint8_t { kUnseen, kFine, kLate, kContradicted };
  using Names = std::vector<std::string>;

  void update_robot(std::uint32_t robot, const decltype(clearance_msg_Health::joints)& joints,
                    const std::function<std::string()>& senders);
  void log_change(const std::string& robot, State before, State now, const Names& names,
                  std::int64_t age_ns) const;

  const Scene& scene_;
  std::vector<State> states_;        // by variable
  std::vector<std::string> others_;  // by variable: who else sends it
  std::vector<bool> silence_said_;   // by robot
  int samples_ = 0;
};

}  // namespace clearance
