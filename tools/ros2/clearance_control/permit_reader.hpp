// Reads the daemon's reports in a thread of its own, and says how fast the joints may be. The loop
// of the controller asks without a lock.
#pragma once

#include <monitor/client/client.hpp>

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "newest_value.hpp"

namespace clearance_control {

// Why commands do not pass.
enum class Cause : std::uint8_t {
  kNone = 0,
  kNotRelied = 1,  // fail_safe() of the client library
  kHeld = 2,       // two faulty messages came; ends after acknowledge()
  kUnknown = 3,    // a figure is unknown, late or not certified, or the cell lacks a name
  kDistance = 4,   // below slow_from
  kZone = 5,       // a zone is active
  kScaling = 6,    // the daemon's scaling is below 1
  kAway = 7,       // positions are away from where the joints stand (Limiter::is_away())
};
[[nodiscard]] const char* name(Cause cause) noexcept;

struct PermitOptions {
  // m. Without them, distances do not limit.
  double stop_at = std::numeric_limits<double>::quiet_NaN();
  double slow_from = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> pairs = {};  // "hand - table"; none: all pairs of the cell
  std::vector<std::string> zones = {};  // those that hold while they are active
  bool obeys_scaling = false;           // of zones with `separation` and of stops
  // The joints of the robot: a cell whose stops are obeyed has to have all of them.
  std::vector<std::string> joints = {};
  clearance::client::StreamOptions stream = {.depth = 4};
};

// What the newest report permits.
struct Permit {
  clearance::client::ReportJudge reports, separations;  // say whether it may be relied on
  bool has_separations = false;
  double scaling = 0.0;     // by distances and zones, 0 to 1
  double of_present = 0.0;  // share of the present speed, by the daemon's scaling, 0 to 1
  // The positions in the report are at most as old as this time, by monotonic_ns().
  std::int64_t since_ns = 0;
  Cause cause = Cause::kUnknown;

  // Returns why no report may be relied on now; kGood: the permit counts.
  [[nodiscard]] clearance::ReportError error(std::int64_t at_ns) const noexcept;
  // The cause with regard to that.
  [[nodiscard]] Cause cause_at(std::int64_t at_ns) const noexcept;
};

class PermitReader {
 public:
  using Tell = std::function<void(const std::string&)>;
  // Throws DdsError, or std::invalid_argument if the options contradict each other. `tell` gets a
  // text when the cause changes, from the thread, and no more than one per second.
  PermitReader(const clearance::DdsOptions& dds, PermitOptions options, Tell tell);
  ~PermitReader();
  PermitReader(const PermitReader&) = delete;
  PermitReader& operator=(const PermitReader&) = delete;

  // For the loop. Valid until the next call.
  const Permit& newest() noexcept { return newest_.get(); }
  // Ends a hold after faulty messages (Stream::acknowledge()), soon.
  void acknowledge() noexcept { is_acknowledged_ = true; }
  [[nodiscard]] const std::string& where() const noexcept { return connection_.where(); }

 private:
  void run();
  [[nodiscard]] Permit judged();
  void limit_by_distances(Permit& permit);
  void limit_by_zones(Permit& permit);
  void limit_by_scaling(Permit& permit);
  // The names of this revision; null: they have not come.
  [[nodiscard]] const clearance_msg_Catalogue* names_of(std::uint64_t revision);
  [[nodiscard]] bool has_joints(std::uint64_t revision);
  void tell_changes(const Permit& permit);

  PermitOptions options_;
  Tell tell_;
  clearance::client::Connection connection_;
  clearance::client::Reports reports_;
  std::optional<clearance::client::Separation> separation_;
  clearance::client::Catalogue names_;
  std::vector<clearance::client::Pair> pairs_;
  std::string told_;
  std::int64_t told_ns_ = 0;
  NewestValue<Permit> newest_;
  std::atomic<bool> is_acknowledged_{false}, stop_{false};
  std::thread thread_;
};

}  // namespace clearance_control
