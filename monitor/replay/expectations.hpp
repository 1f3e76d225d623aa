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

  // To be called for every tick; judges only if told. Until all moving objects have been known
  // once, only a pair that is certainly too near counts. A pair whose contact is as allowed may be
  // nearer. Returns one sentence for each expectation
  // that is broken for the first time.
  [[nodiscard]] std::vector<std::string> check(const Report& report, const Monitor& monitor,
                                               bool judge);

  // Ticks are of another scene from now on, which outlives this. Expectations begin again once all
  // of its moving objects are known. A zone that it lacks is not active.
  void change(const Scene& scene);

  // After the last tick: the reason why no tick could be judged, if none was.
  [[nodiscard]] std::optional<std::string> never_judged(const Monitor& monitor) const;

 private:
  struct NoZone {
    std::string name;
    std::optional<std::uint32_t> zone;  // none: the scene has no such zone
    bool broken = false;
  };

  [[nodiscard]] bool all_seen(const Monitor& monitor);
  [[nodiscard]] std::optional<std::string> check_distance(const Report& report,
                                                          const Monitor& monitor);
  [[nodiscard]] std::optional<std::string> certainly_near(const Report& report,
                                                          const Monitor& monitor);
  [[nodiscard]] std::optional<std::string> check_sweep(const Report& report,
                                                       const Monitor& monitor);

  [[nodiscard]] std::optional<std::uint32_t> zone(const std::string& name) const;

  const Scene* scene_;
  std::optional<double> min_distance_;
  bool distance_broken_ = false;
  std::vector<NoZone> no_zone_;
  bool all_known_ = false;
  bool judged_ = false;  // some tick
  std::string error_;
};

}  // namespace clearance
