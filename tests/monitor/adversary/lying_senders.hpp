// The programs that send the inputs of the cell of inputs that lie, as bytes on topics. Faults
// change what they say, and rivals say other things.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "monitor/intake/intake.hpp"
#include "monitor/wire/cdr.hpp"
#include "tests/monitor/adversary/lies.hpp"
#include "tests/monitor/adversary/true_motion.hpp"

namespace clearance::test::lies {

struct Sending {
  std::uint64_t seed = 1;
  std::vector<Fault> faults = {};
  double loss = 0.0;        // share of messages
  std::int64_t jitter = 0;  // ns, of the delay of messages, which stay in order
  bool wraps = false;       // continuous joints stay within plus or minus pi
  // Time is that of a simulation, which sends /clock and runs so many times as fast as the clocks
  // of the machine; none: it is theirs.
  std::optional<double> factor = {};

  // The time of the machine, ns since the start.
  [[nodiscard]] std::int64_t machine_time(std::int64_t t) const {
    return factor ? std::llround(static_cast<double>(t) / *factor) : t;
  }
};

class LyingSenders {
 public:
  // Receives the writers that exist, when they change.
  using Keep = std::function<void(std::vector<std::uint64_t> writers)>;

  // `start_ns` is CLOCK_REALTIME at time 0, and the simulated time. All arguments must outlive
  // this.
  LyingSenders(const Scene& scene, const TrueMotion& truth, const Sending& sending,
               std::int64_t start_ns, Intake& intake, Keep keep);

  // Sends what is sent at `t`, ns since the start, and delivers what arrives until then.
  void send(std::int64_t t);

 private:
  struct Message {
    std::int64_t due = 0;
    std::uint32_t topic = 0;
    std::uint64_t writer = 0;
    std::int64_t sent_ns = 0;
    std::vector<std::byte> cdr;
  };
  static constexpr std::uint64_t kCameraDriver = 301;  // the writer of CameraInfo
  // The message of one writer on a channel.
  struct Words {
    TruePose pose = TruePose::Identity();
    Twist twist;
    std::array<TrueJoint, kJoints + 1> joints{};  // the last one is the first one again
    std::size_t told_joints = kJoints;            // the first ones
    bool has_velocities = false, is_static = false;
    double quaternion_scale = 1.0;
    bool has_too_few = false;
    std::string parent;  // of a frame, or of what is seen
    std::array<Eigen::Vector3f, kSeenPoints> points{};
    std::vector<std::uint16_t> depths = {};  // of the picture, mm
    TruePoint walker = TruePoint::Zero();    // in the frame of the map
    double scale = 1.0;                      // of the map's cubes
    bool is_empty = false;                   // the map
    bool has_other_layout = false, is_padded = false, is_torn = false;
    std::int64_t stamp_ns = 0;
  };

  void keep_writers(std::int64_t t);
  void speak(Channel channel, std::int64_t t);
  void speak_as_rival(Channel channel, const Rival& rival, std::int64_t t);
  [[nodiscard]] const Fault* fault_of(Channel channel) const;
  [[nodiscard]] Words words(Channel channel, const Told& told, std::int64_t t) const;
  [[nodiscard]] Message message(Channel channel, const Words& words, bool is_rival);
  [[nodiscard]] Message poses(Channel channel, const Words& words, bool is_rival);
  [[nodiscard]] Message joint_states(Channel channel, const Words& words, bool is_rival);
  [[nodiscard]] Message frames(Channel channel, const Words& words);
  void see(Channel channel, const Told& told, std::int64_t t, Words& words) const;
  [[nodiscard]] Message seen(Channel channel, const Words& words);
  [[nodiscard]] Message camera_info(std::int64_t t);
  [[nodiscard]] Message clock(std::int64_t t);
  [[nodiscard]] Message message_of(const char* name, const char* type,
                                   const std::vector<std::byte>& cdr);
  void post(Message message, std::int64_t t, const Told& told, Channel channel);
  void deliver(std::int64_t t);
  [[nodiscard]] std::uint32_t topic(const std::string& name, const std::string& type);

  const Scene& scene_;
  const TrueMotion& truth_;
  const Sending& sending_;
  const std::int64_t start_ns_;
  Intake& intake_;
  Keep keep_;
  Random random_;
  CdrEncoder encoder_;
  std::array<bool, kChannels> sends_velocities_{};
  std::array<int, kChannels> lost_in_a_row_{};
  std::array<bool, 2> by_ros_{};  // arm and post
  std::array<std::int64_t, kChannels> period_{}, last_due_{};
  std::array<std::uint64_t, 2 * kChannels> sequence_{};
  std::multimap<std::int64_t, Message> in_flight_;  // by Message::due, in the order of sending
  std::vector<std::uint64_t> writers_;
};

}  // namespace clearance::test::lies
