// Expectations of a user's test that every tick must meet; the first tick that breaks one is
// reported.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/monitor.hpp"

namespace clearance {

// Each expectation is told once, at the tick that breaks it first. Bounds decide: what is not
// certified counts as broken.
class Expectations {
 public:
  // `min_distance`, m: of every pair in every tick and at every instant since the last. Zone names
  // that the scene does not have are told in error().
  Expectations(const Scene& scene, std::optional<double> min_distance,
               const std::vector<std::string>& no_zone);

  [[nodiscard]] const std::string& error() const noexcept { return error_; }

  // One sentence about the tick that broke an expectation.
  struct Broken {
    std::uint64_t cycle = 0;
    std::int64_t now_ns = 0;
    std::string what;
  };

  // To be called for every tick; judges only if told. Until all moving objects have been known
  // once, only a pair that is certainly too near counts. A pair whose contact is as allowed may be
  // nearer. Returns each expectation that is broken for the first time.
  //
  // While an object is late, pairs of two other objects are judged as ever, and its own pairs count
  // at once where they are known and certainly too near. What its own pairs break otherwise is
  // returned once it is on time again, or by finish().
  [[nodiscard]] std::vector<Broken> check(const Report& report, const Monitor& monitor, bool judge);

  // Ticks are of another scene from now on, which outlives this. Expectations begin again once all
  // of its moving objects are known. A zone that it lacks is not active.
  void change(const Scene& scene);

  // Call this after the recording's last tick. Returns what was first broken while an object was
  // late and has not been returned yet. If the object was late for at most 1 s, its driver is taken
  // to have ended before the recording. Then this returns nothing and says so in `note`.
  [[nodiscard]] std::vector<Broken> finish(std::int64_t last_ns, std::string& note);

  // After the last tick: the reason why no tick could be judged, if none was.
  [[nodiscard]] std::optional<std::string> never_judged(const Monitor& monitor) const;

 private:
  // Every tick must meet it: the minimum distance, or that a zone is not active.
  struct Expectation {
    std::string zone;                       // empty: the minimum distance
    std::optional<std::uint32_t> index;     // of the zone; none: the scene has no such zone
    bool broken = false;                    // and returned
    std::optional<Broken> while_late = {};  // first broken while an object was late
    // The objects that were late then. Empty: the cell has changed since.
    std::vector<std::uint32_t> late_then = {};
  };
  struct Lateness {
    std::int64_t since_ns = 0;
    std::uint64_t refused = 0;  // samples of all objects until then
  };

  using Sentence = std::optional<std::string>;  // about an expectation that the tick breaks

  [[nodiscard]] bool all_seen(const Monitor& monitor);
  void note_late(const Report& report, const Monitor& monitor);
  [[nodiscard]] bool has_late_object(std::uint32_t pair) const;
  // Returns the object that has been late for longest, or nothing if one of these is on time.
  [[nodiscard]] std::optional<std::uint32_t> longest_late(
      const std::vector<std::uint32_t>& objects) const;
  [[nodiscard]] Sentence broken_by(const Expectation& expectation, const Report& report,
                                   const Monitor& monitor) const;
  // For a tick with a late object. Returns a sentence if a pair without late objects breaks the
  // expectation, or if a pair is certainly too near.
  [[nodiscard]] Sentence surely_broken_by(const Expectation& expectation, const Report& report,
                                          const Monitor& monitor) const;
  [[nodiscard]] Sentence entered_surely(std::uint32_t zone, const Report& report,
                                        const Monitor& monitor) const;
  [[nodiscard]] Sentence certainly_near(const Report& report, const Monitor& monitor) const;
  // `late_too`: pairs with a late object count, too.
  [[nodiscard]] Sentence check_distance(const Report& report, const Monitor& monitor,
                                        bool late_too) const;
  [[nodiscard]] Sentence check_sweep(const Report& report, const Monitor& monitor,
                                     bool late_too) const;

  [[nodiscard]] std::optional<std::uint32_t> zone(const std::string& name) const;

  const Scene* scene_;
  std::optional<double> min_distance_;
  std::vector<Expectation> expectations_;
  bool all_known_ = false;
  bool judged_ = false, judged_on_time_ = false;  // some tick; one in which no object was late
  std::string error_;
  std::vector<std::optional<Lateness>> late_;  // by object, in this tick
  bool any_late_ = false;
  std::uint64_t refused_ = 0;  // samples of all objects until now
};

}  // namespace clearance
