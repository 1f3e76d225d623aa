// Moves the objects of a cell with the aim that the tick reports something false.
//
// The adversary knows the true pose of every object and what the monitor has been told of it. It
// therefore knows what the monitor's bounds refer to: the poses in use, and the true poses of late
// objects.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <vector>

#include "monitor/tick/monitor.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

enum class Style {
  kCrawl,     // every point stays well below 3 m/s
  kJitter,    // motion of nanometres
  kSpin,      // large rotations about the objects' origins
  kTeleport,  // occasional jumps
  kDart,      // rest, then jumps of decimetres for a few ticks
  kBullets,   // through everything and back at up to 0.3 m per tick, while tumbling
  kCrowd,     // all objects gather around one wandering point
  kAway,      // jumps of 30 km and back, farther than displacements are added up
  kLate,      // crawls; single objects fall silent for up to 80 ticks
  kAllLate,   // crawls; all objects fall silent together
  kLost,      // darts; one sample in three is lost
};
std::ostream& operator<<(std::ostream& out, Style style);

// Returns true if objects of this style may be late.
[[nodiscard]] bool falls_silent(Style style);

class Adversary {
 public:
  // `room`: the largest initial coordinate of an object along each axis, m.
  Adversary(const Scene& scene, Style style, double room, std::uint64_t seed);

  // Moves all objects, sends their poses to the monitor, and returns its report.
  const Report& tick(Monitor& monitor);
  // Lets all objects rest, and every pose come, until the end of the run.
  void rest() noexcept { rests_ = true; }

  // The pose that the monitor's bounds of this tick refer to.
  [[nodiscard]] const Pose& now(std::uint32_t object) const { return objects_[object].now; }
  // The pose at the fraction `s` of the interval since the last tick.
  [[nodiscard]] Pose since(std::uint32_t object, double s) const {
    return between(objects_[object].before, objects_[object].now, s);
  }
  // Returns true if both objects of the pair were known in the last tick and are known in this one.
  // Only then do swept bounds cover the time between.
  [[nodiscard]] bool was_known(std::uint32_t pair) const;
  // A random instant between two ticks, in [0, 1].
  [[nodiscard]] double any_instant() { return random_.uniform(0.0, 1.0); }

 private:
  struct Told {
    Pose pose;         // true pose of the object
    Pose sent;         // pose last sent to the monitor
    Pose now, before;  // poses that the monitor's bounds refer to, in this tick and the last
    Vec3 velocity;     // of bullets, m per tick
    int silence = 0;   // remaining silence, ticks
    bool known = false, known_before = false;
  };

  [[nodiscard]] bool is_silent(Told& object);
  void move(Told& object);
  void jump(Pose& pose, double chance, double room);
  void learn(const Monitor& monitor);

  const Scene& scene_;
  const Style style_;
  const double room_;
  Random random_;
  std::vector<Told> objects_;
  int tick_ = 0;
  bool rests_ = false;
  std::int64_t now_ns_;
};

}  // namespace clearance::test
