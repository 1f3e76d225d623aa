// An overview of a recording: the least distance over time, the active zones, the notable moments,
// and the data to jump to any of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/replay/scene_history.hpp"
#include "tools/view/cell_changes.hpp"
#include "tools/view/run_history.hpp"

namespace clearance::view {

struct Moment {
  std::int64_t time_ns = 0;  // log time
  std::string kind;          // "closest", "zone", "overrun", "cell"
  std::string text;          // for a person
};

struct ZoneSpan {
  std::uint32_t zone = 0;
  std::int64_t begin_ns = 0, end_ns = 0;
};

// A state of a zone, which holds until the next one.
struct ZoneMessage {
  std::uint32_t zone = 0;
  std::int64_t log_ns = 0;
  std::vector<std::byte> cdr = {};
};

// Reports are of this scene from this log time on.
struct SceneSince {
  std::int64_t log_ns = 0;
  std::uint64_t revision = 0;
  std::vector<Attached> attached = {};
};

struct Timeline {
  std::string error;  // empty, or why the file cannot be shown
  std::int64_t begin_ns = 0, end_ns = 0;
  std::vector<std::int64_t> reports;  // log times
  RunHistory history;
  std::vector<SceneSince> scenes;  // in order of time, the first one first
  std::vector<ZoneSpan> zones;
  std::vector<ZoneMessage> zone_messages;  // in order of time
  std::vector<Moment> moments;             // in order of time; "closest" is the least of all

  [[nodiscard]] std::string json() const;
};

inline constexpr std::size_t kMostStretches = 2000, kMostMoments = 200;

// Reads the whole file once; `progress` receives the share that was read, 0 to 1. The history is
// that of the file.
[[nodiscard]] Timeline read_timeline(SceneHistory& scenes, const std::filesystem::path& file,
                                     const std::function<void(double)>& progress = {});

}  // namespace clearance::view
