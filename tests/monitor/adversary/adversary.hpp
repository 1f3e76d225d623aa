// Somebody who moves the objects of a cell so as to make the tick report something false.
//
// The adversary knows where every object is, what the monitor has been told of it, and therefore
// what the monitor's bounds are about: the poses in use, and of late objects the true ones.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <vector>

#include "monitor/monitor.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

enum class Style {
  kCrawl,     // every point keeps well below 3 m/s
  kJitter,    // nanometres
  kSpin,      // large turns about the objects' origins
  kTeleport,  // jumps, now and then
  kDart,      // rest, then jumps of decimetres for a few ticks
  kBullets,   // through everything at up to 0.3 m a tick, tumbling, and back
  kCrowd,     // all gather around one wandering point
  kAway,      // jumps of 30 km and back, farther than displacements are added up
  kLate,      // crawls; single objects fall silent for up to 80 ticks
  kAllLate,   // crawls; all objects fall silent together
  kLost,      // darts; one sample in three is lost
};
std::ostream& operator<<(std::ostream& out, Style style);

// Whether objects of this style may be late.
[[nodiscard]] bool falls_silent(Style style);

class Adversary {
 public:
  // `room`: objects start within this of the origin along each axis, m.
  Adversary(const Scene& scene, Style style, double room, std::uint64_t seed);

  // Moves everything, tells the monitor, and returns its report.
  const Report& tick(Monitor& monitor);

  // What the monitor's bounds of this tick are about.
  [[nodiscard]] const Pose& now(std::uint32_t object) const { return objects_[object].now; }
  // At `s` of the way since the last tick.
  [[nodiscard]] Pose since(std::uint32_t object, double s) const {
    return between(objects_[object].before, objects_[object].now, s);
  }
  // Both objects of the pair were known at the last tick and are in this one, so that swept bounds
  // say something about the time between.
  [[nodiscard]] bool was_known(std::uint32_t pair) const;
  // Any instant between two ticks, in [0, 1].
  [[nodiscard]] double any_instant() { return random_.uniform(0.0, 1.0); }

 private:
  struct Told {
    Pose pose;         // where the object is
    Pose sent;         // as the monitor was told last
    Pose now, before;  // what the monitor's bounds are about, in this tick and the last
    Vec3 velocity;     // m a tick, of bullets
    int silence = 0;   // ticks
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
  std::int64_t now_ns_;
};

}  // namespace clearance::test
