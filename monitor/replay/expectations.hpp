// Expectations of a user's test that every tick must meet; the first tick that breaks one is
// reported.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/replay/expected_distance.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance {

// What a test expects of every tick.
struct Expected {
  std::vector<ExpectedDistance> distances;
  std::vector<std::string> no_zone;  // names of zones that are never active
  double allow_unknown = 0.0;        // the share of judged ticks in which a pair may be unknown
};

// Each expectation is told once, at the tick that breaks it first. Bounds decide: what is not
// certified counts as broken.
//
// An expectation rests on its pairs. It is judged from the first tick in which all moving objects
// of these pairs are known and on time; before, only what is certain of known pairs counts. From
// then on a tick is doubtful if one of its pairs is unknown, or late and not certainly too near.
// More doubtful ticks than allowed break it. A pair whose contact is as allowed may be nearer.
//
// A change of the scene does not end this. Objects with new names are awaited: until they are known
// and on time first, only what is certain of their pairs counts. One that is awaited for more than
// 1 s at the end breaks the expectation.
class Expectations {
 public:
  // Names that the scene does not have are told in error().
  Expectations(const Scene& scene, const Expected& expected);

  [[nodiscard]] const std::string& error() const noexcept { return error_; }

  // One sentence about the tick that broke an expectation.
  struct Broken {
    std::uint64_t cycle = 0;  // 0: no tick, all of them
    std::int64_t now_ns = 0;
    std::string what;
    std::string expectation = {};  // Outcome::expectation
  };

  // To be called for every tick; judges only if told. Returns each expectation that is certainly
  // broken for the first time.
  [[nodiscard]] std::vector<Broken> check(const Report& report, const Monitor& monitor, bool judge);

  // Ticks are of another scene from now on, which outlives this. Objects correspond by name. A zone
  // or an object that it lacks is not judged.
  void change(const Scene& scene);

  // Call this after the recording's last tick. Returns what was doubtful too often, and what could
  // not be judged in any tick. If an object was late for at most 1 s then, its driver is taken to
  // have ended before the recording, and these ticks are not doubtful.
  [[nodiscard]] std::vector<Broken> finish(const Monitor& monitor, std::int64_t last_ns);

  // Tells, after finish(), how many ticks of each expectation were not judged, or were doubtful and
  // allowed.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }
  // Each expectation in words, and its least distance in the ticks that were to be judged.
  struct Outcome {
    std::string expectation;  // "at least 0.05 m of arm - table", "zone 'stop'"
    std::string least;        // empty: no pair was known and on time in any of them
    std::uint64_t cycle = 0;
    std::int64_t now_ns = 0;
  };
  [[nodiscard]] std::vector<Outcome> outcomes() const;
  // The most ticks that one expectation was not judged in.
  [[nodiscard]] std::uint64_t not_judged() const noexcept;

 private:
  // The minimum distance of pairs, or that a zone is not active.
  struct Expectation {
    std::optional<ExpectedDistance> distance;  // none: a zone
    std::string zone;
    std::optional<std::uint32_t> index;  // of the zone; none: the scene has no such zone
    // Of the scene, but those that a robot's own build keeps nearer.
    bool all_pairs = false;
    std::vector<std::uint32_t> pairs;      // in ascending order
    std::vector<std::uint32_t> objects;    // the moving ones of these
    bool begun = false, broken = false;    // broken: and returned
    bool judged_on_time = false;           // in some tick, no object of it was late
    std::uint64_t judged = 0, before = 0;  // ticks; those before it had begun
    std::int64_t begun_after_ns = 0;       // since the first tick
    std::uint64_t doubtful = 0;
    std::optional<Broken> first_doubt = {};
    // Doubtful ticks since these objects are late. They are left out if the recording ends so.
    std::uint64_t late_doubts = 0;
    std::optional<Broken> first_late_doubt = {};
    std::vector<std::uint32_t> late_then = {};
    double least = std::numeric_limits<double>::infinity();  // m; `outcome` tells of it
    Outcome outcome = {};
  };
  struct Lateness {
    std::int64_t since_ns = 0;
    std::uint64_t refused = 0;  // samples of all objects until then
  };
  struct Tick {
    const Report& report;
    const Monitor& monitor;
  };
  // Why a tick breaks an expectation. `certain`: no bound of an unknown or late pair decided.
  struct Finding {
    std::string what;
    bool certain = true;
  };
  using Found = std::optional<Finding>;

  void rest_on(Expectation& expectation);
  [[nodiscard]] std::string unknown_name(const Expectation& expectation) const;
  void note_late(const Report& report, const Monitor& monitor);
  [[nodiscard]] bool begins(const Expectation& expectation, const Monitor& monitor) const;
  [[nodiscard]] bool is_late(const Expectation& expectation) const;
  [[nodiscard]] bool has_late_object(std::uint32_t pair) const;
  [[nodiscard]] bool is_awaited(const Expectation& expectation) const;
  [[nodiscard]] bool has_awaited_object(std::uint32_t pair) const;
  // Returns that an object of it was awaited for too long at the end.
  [[nodiscard]] std::optional<Broken> never_known(const Expectation& expectation,
                                                  std::int64_t last_ns);
  // Returns the object that has been late for longest, or nothing if one of these is on time.
  [[nodiscard]] std::optional<std::uint32_t> longest_late(
      const std::vector<std::uint32_t>& objects) const;
  void doubt(Expectation& expectation, Broken broken) const;
  void end_lateness(Expectation& expectation, const std::string& why) const;
  void finish_lateness(Expectation& expectation, std::int64_t last_ns);
  [[nodiscard]] Found found(const Expectation& expectation, const Tick& tick) const;
  // Without unknown pairs, and of late ones what is certain.
  [[nodiscard]] Found found_certain(const Expectation& expectation, const Tick& tick) const;
  [[nodiscard]] Found entered(const Expectation& expectation, const Tick& tick) const;
  // By a pair without an awaited object. `certain`: by a known pair, and of a late one by its upper
  // bound.
  [[nodiscard]] Found entered_by_pair(const Expectation& expectation, const Tick& tick,
                                      bool certain) const;
  [[nodiscard]] Found certainly_near(const Expectation& expectation, const Tick& tick) const;
  [[nodiscard]] Found too_near(const Expectation& expectation, const Tick& tick) const;
  [[nodiscard]] Found swept_too_near(const Expectation& expectation, const Tick& tick) const;
  void note_least(Expectation& expectation, const Tick& tick) const;
  void note_ticks(const Expectation& expectation);

  const Scene* scene_;
  double allow_unknown_ = 0.0;
  std::vector<Expectation> expectations_;
  std::string error_;
  std::vector<std::string> notes_;
  std::optional<std::int64_t> first_ns_;
  // By object: since when it waits to be known and on time for the first time; nothing: it was.
  std::vector<std::optional<std::int64_t>> awaited_ns_;
  std::vector<std::optional<Lateness>> late_;  // by object, in this tick; none that is awaited
  std::vector<bool> lost_;     // by object: no value of it is in use any more, in this tick
  std::uint64_t refused_ = 0;  // samples of all objects until now
};

}  // namespace clearance
