// A recording, played like a film. Every viewer of the server sees the same moment, and any of them
// may move it by these parameters:
//   playback.playing  true or false
//   playback.time     s after the first report; shows the last report up to the time that is set
//   playback.rate     multiples of the recorded speed, 0.01 to 100
//   playback.step     set only: so many reports on, negative: back
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "monitor/recording/reader.hpp"
#include "monitor/recording/reading_place.hpp"
#include "monitor/visual/recorded_sensors.hpp"
#include "tools/view/frame.hpp"
#include "tools/view/source.hpp"
#include "tools/view/timeline.hpp"

namespace clearance::view {

class RecordingSource final : public Source {
 public:
  // `timeline` is of this file and without an error. `scenes` is the history of the file, which
  // begins with the cell.
  RecordingSource(std::shared_ptr<const Cell> cell, std::unique_ptr<SceneHistory> scenes,
                  std::filesystem::path file, Timeline timeline);

  [[nodiscard]] std::shared_ptr<const Cell> cell() const override { return cell_; }
  void advance(Server& server) override;
  [[nodiscard]] nlohmann::json parameters() const override;
  [[nodiscard]] std::string distance(std::uint32_t a, std::uint32_t b) override {
    return frame_->distance_json(a, b);
  }
  void set(const std::string& name, const nlohmann::json& value) override;
  [[nodiscard]] std::string sensors() const override;
  [[nodiscard]] std::string timeline() const override { return timeline_.json(); }
  [[nodiscard]] std::string history(double end_s, double width_s,
                                    std::span<const std::uint32_t> pairs) const override;

 private:
  void go_on(std::int64_t steady_ns);
  void go_to(std::int64_t time_ns);
  void step(std::int64_t reports);
  void read_up_to(std::int64_t time_ns);
  void follow_the_time();
  void begin_reading(const McapWindow& window);
  void show_what_is_seen(Server& server);
  [[nodiscard]] std::int64_t at(double seconds) const;
  [[nodiscard]] const SceneSince* scene_now() const;  // null: before the first report

  std::shared_ptr<const Cell> first_, cell_;  // of the recording; at this time
  std::unique_ptr<SceneHistory> scenes_;
  std::filesystem::path file_;
  Timeline timeline_;
  std::unique_ptr<Frame> frame_;
  RecordedSensors sensors_;
  // Poses of objects that move seldom, and health, come once per second.
  ReadingPlace place_{1'200'000'000};
  std::unique_ptr<RecordingReader> reader_;
  RecordedMessage next_;  // read, but still to come
  bool has_next_ = false;
  std::int64_t time_ns_;  // time of the view
  std::int64_t steady_ns_ = 0;
  bool playing_ = false, changed_ = true;
  double rate_ = 1.0;
};

}  // namespace clearance::view
