// Where tf has the frame of a sensor in what carries it, judged as poses of objects are: taken when
// it can have got there.
//
// Frames of a path may leap and correct each other, as those of a localisation and its odometry do.
// So the path is judged as a whole, at the stamps of all its transforms.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/scene/carrier.hpp"
#include "config/scene/sensor.hpp"
#include "core/pose.hpp"
#include "monitor/bodies/landmarks.hpp"
#include "monitor/inputs/track.hpp"

namespace clearance {

struct CarriedPose {
  Carrier carrier;
  Pose pose;  // of the frame, in its carrier
};

// The length and the angle of a path, as the metric of Plausibility. A limit is the time, s, in
// which the path comes so far. Two carriers are not compared: how far they are apart is known
// later.
struct PathMetric {
  using Value = CarriedPose;
  using Rate = Twist;
  MountSpeed speed;

  [[nodiscard]] bool stay_within(double limit, const CarriedPose& from,
                                 const CarriedPose& to) const noexcept;
  // tf sends no rates.
  [[nodiscard]] static double length(const Twist& rate) noexcept { return rate.linear.norm(); }
  [[nodiscard]] static Twist scaled_sum(double factor, const Twist& a, const Twist& b) noexcept {
    return Landmarks::scaled_sum(factor, a, b);
  }
  [[nodiscard]] static CarriedPose moved(const CarriedPose& from, const Twist& step) noexcept {
    return {from.carrier, Landmarks::moved(from.pose, step)};
  }
  static constexpr bool kRatesMayBeWrong = false;
};

struct TrackedPath {
  InputRecord input;
  CarriedPose value;  // in use
  Repetition repetition;
  Plausibility<PathMetric> plausibility;
};

class MountTrack {
 public:
  // At 1 kHz, two seconds.
  static constexpr std::size_t kKept = 2048;

  struct Limits {
    MountSpeed speed;         // stated by the cell, or not
    std::int64_t age_ns = 0;  // of the sensor: the largest timing error
    std::int64_t future_ns = 0;
  };
  explicit MountTrack(const Limits& limits) : limits_(limits), track_({}, kKept) {}

  // A pose of the path at a stamp. `source` has the suffixes of the claims that it follows from.
  void add(const std::string& source, const CarriedPose& value, std::int64_t stamp_ns,
           std::int64_t now_ns);
  // What the path would be at this stamp by the claim of a rival; nothing: it has no place. The
  // same claim counts once for one stamp.
  void add_rival(const std::string& source, const std::optional<CarriedPose>& value,
                 std::int64_t stamp_ns, std::int64_t now_ns);
  void forget() { track_.begin_anew({}); }
  // The cell states other limits now.
  void limit(const Limits& limits) noexcept { limits_ = limits; }

  [[nodiscard]] bool has_value() const noexcept { return track_.now.input.has_value; }
  [[nodiscard]] const CarriedPose& value() const noexcept { return track_.now.value; }
  // The stamp of the last pose that was judged; taken or not.
  [[nodiscard]] std::int64_t judged_until() const noexcept { return judged_until_ns_; }
  // True if it is not known where the frame was at some time from the first to the last.
  [[nodiscard]] bool is_contradicted(std::int64_t first_ns, std::int64_t last_ns) const noexcept {
    return track_.past.is_contradicted(first_ns, last_ns);
  }

  // The excess of the path's motion within the second before this stamp over what the stated speeds
  // allow. Without them, the whole distance of what needs more than 5 m/s or 6.3 rad/s.
  struct Excess {
    double shift = 0.0, turn = 0.0;  // m, rad
  };
  [[nodiscard]] Excess excess(std::int64_t last_ns) const;

 private:
  struct Candidate;
  struct Source {
    std::string name;
    std::int64_t rival_ns = 0;  // the last stamp of its claim as a rival
  };
  [[nodiscard]] Source& source_of(const std::string& name);
  void take(const Source& source, const std::optional<CarriedPose>& value, std::int64_t stamp_ns,
            std::int64_t now_ns);

  Limits limits_;
  Track<TrackedPath, Pose> track_;
  std::int64_t judged_until_ns_ = 0;
  std::vector<Source> sources_;  // by number
};

}  // namespace clearance
