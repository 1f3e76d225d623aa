// Writes replayed ticks as a table with one row for each tick and pair.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "config/scene/scene.hpp"
#include "monitor/replay/offline_replay.hpp"

namespace clearance {

// Columns: tick,now_ns,object_a,object_b, then the fields of PairReport in their order, without
// pair, parts and evaluated_cycle:
// status,distance,lower,upper,swept_lower,model_error,stop_lower,ax,ay,az,bx,by,bz,nx,ny,
// nz,closing_speed,time_to_contact,age_a_ns,age_b_ns,refresh_age_cycles. They are in SI units and
// in the world frame, and numbers read back exactly. The column scene_revision is that of
// the cell which was in force, in hexadecimal digits; its names are in the row. After it come the
// contact that is allowed for the pair, its status and depth; they are empty where there is none.
// The last columns are those of robots with `stopping`: NAME/stop_validity, stop_scaling,
// stop_clearance, stop_pair, stop_share and stop_time, the same in all rows of a tick. The robots
// are those of the first scene. A later scene without such a robot leaves its columns empty.
// Errors are kept: error() says what happened.
class ReportCsv {
 public:
  // `all_pairs`: every pair of the scene; otherwise those that it publishes.
  ReportCsv(const std::filesystem::path& file, const Scene& scene, bool all_pairs);

  void add(const ReplayedTick& tick);
  bool close();
  [[nodiscard]] const std::string& error() const noexcept { return error_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void follow(const Scene& scene);
  void note_stops(const Report& report);
  void add_row(const Report& report, const PairReport& pair);
  void add_contact(const Report& report, std::uint32_t pair);
  void add_hidden(const Report& report, std::uint32_t pair);
  void write();

  std::filesystem::path path_;
  const Scene* scene_ = nullptr;  // of the last tick
  bool all_pairs_;
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<std::string> names_;     // of the objects, quoted where needed
  std::vector<std::string> contacts_;  // their names, quoted as well
  std::vector<std::string> robots_;    // of the first scene, those that state how they stop
  std::string stops_;                  // their columns in this tick
  std::string revision_;
  std::string rows_;  // not written yet
  std::string error_;
};

}  // namespace clearance
