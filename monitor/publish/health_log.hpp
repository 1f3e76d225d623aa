// Logs the news in each health sample for a person: the changes since the previous sample.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "config/scene/scene.hpp"
#include "monitor/publish/joint_log.hpp"
#include "monitor/publish/refusal_log.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// Logs new rejections, losses and late inputs: a few lines a second at most.
class HealthLog {
 public:
  // The scene must outlive this, or its use until the next call of change().
  explicit HealthLog(const Scene& scene);
  // The following samples are of this scene. What has been told of an input is not told again under
  // the same name.
  void change(const Scene& scene);
  // Called with every sample, in order. `senders_of_joints` names the senders of joint states when
  // that is needed.
  void update(const clearance_msg_Health& health,
              const std::function<std::string()>& senders_of_joints);

 private:
  void log_clock(const clearance_msg_Health& health);
  void log_notes(const clearance_msg_Health& health);
  void log_response(const clearance_msg_Health& health);

  RefusalLog refusals_;
  struct Poses {
    bool stale = false;
    std::int64_t stamp_ns = 0;  // of the value in use when that was told
    bool is_of_sensor = false;
    std::string other_source;
  };
  void note_sensors(const Scene& scene);
  static void log_late(const clearance_msg_InputAge& input, const Poses& now);
  std::map<std::string, Poses> poses_;  // by object
  // By input: the takeovers, and whether its velocities were told of.
  struct Note {
    std::uint32_t takeovers = 0;
    bool velocities_said = false;
  };
  std::map<std::string, Note> notes_;
  JointLog joints_;
  std::uint64_t late_responses_ = 0;
  bool response_is_late_ = false;
  std::uint64_t clock_steps_ = 0;
  std::int64_t clock_offset_ns_ = 0;
  // A count whose growth is told: at once, then after pauses that double while it goes on growing.
  struct Growth {
    std::uint64_t before = 0, told = 0;
    int silent_s = 0, quiet_s = 0;  // since the last line; since it grew last
    int pause_s = 0;                // until the next line
    // Called each second. Returns by how much it has grown since the last line; 0: no line is due.
    [[nodiscard]] std::uint64_t update(std::uint64_t now) noexcept;
  };
  Growth lost_, undecodable_, foreign_, overruns_, dropped_;
};

}  // namespace clearance
