// The topics of a running daemon, as any client reads them: of the reports the newest only.
#pragma once

#include <array>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "monitor/client/checked_reader.hpp"
#include "monitor/client/report_judge.hpp"
#include "monitor/dds/ros_readers.hpp"
#include "monitor/participant/cdr_sample.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/visual/seen_frames.hpp"
#include "tools/view/asked_path.hpp"
#include "tools/view/cell_changes.hpp"
#include "tools/view/frame.hpp"
#include "tools/view/merged_reports.hpp"
#include "tools/view/source.hpp"

namespace clearance::view {

class LiveSource final : public Source {
 public:
  // Throws DdsError. When the daemon changes its cell, the catalogue has its text, and the files
  // that it names are beside the first one.
  LiveSource(std::shared_ptr<const Cell> cell, const DdsOptions& dds);

  [[nodiscard]] std::shared_ptr<const Cell> cell() const override { return cell_; }

  // What is attached is known with the first catalogue.
  [[nodiscard]] nlohmann::json parameters() const override;
  // Answers without a viewer, too: reads the topics as if one were there.
  [[nodiscard]] std::string distance(std::uint32_t a, std::uint32_t b) override;
  [[nodiscard]] std::string sensors() const override;

  // Without viewers nothing is taken: readers of poses keep the newest, and there are none of
  // reports.
  void advance(Server& server) override;

 private:
  [[nodiscard]] std::unique_ptr<Frame> make_frame();
  void hear(const RawSensorMessage& message);
  void show_what_is_seen(Server& server, std::int64_t steady_ns);
  void take_all(std::int64_t steady_ns);
  void join(TopicKind kind);
  void leave(Server& server);
  void take(TopicKind kind, std::int64_t steady_ns);
  [[nodiscard]] bool are_all_needed(dds_entity_t reader);
  void merge(std::int64_t steady_ns);
  [[nodiscard]] bool is_shown(TopicKind kind, const CdrSample& sample, std::int64_t steady_ns);
  [[nodiscard]] bool is_good(const CdrSample& report, std::int64_t steady_ns);
  template <class Message>
  [[nodiscard]] bool is_sound(TopicKind kind, const CdrSample& sample, Sample<Message>& message);
  void take_from_ros(const Now& now);
  void take_questions(Server& server);
  void follow_the_catalogue(Server& server);
  void note_the_catalogue();
  void note_what_is_attached(Server& server);
  void tell_of_the_daemon(Server& server, std::int64_t now_ns, std::int64_t steady_ns);

  std::shared_ptr<const Cell> cell_;
  const Topics topics_;
  Participant participant_;
  std::array<dds_entity_t, kRecordedTopics.size()> readers_{};  // 0: there is none
  std::vector<CdrSample> taken_;
  std::unique_ptr<SeenFrames> seen_;  // null: the cell has no sensors
  bool is_seen_wanted_ = false;       // by a viewer
  std::unique_ptr<Frame> frame_;
  dds_entity_t questions_, answers_;  // readers
  AskedPath asked_;                   // of the frame's scene
  CdrDecoder decoder_;
  Intake intake_;                    // of ROS 2's topics
  std::future<CellResult> reading_;  // not valid: no cell is being read
  std::uint64_t read_ = 0;           // the revision that was read last, or is being read
  std::vector<Attached> attached_;
  struct Told {
    std::uint64_t revision = 0, in_force_from = 0, daemon = 0;
  };
  Told told_;                      // by the last catalogue
  std::uint64_t attached_of_ = 0;  // the revision that these are of; 0: none yet
  std::uint64_t daemon_ = 0;       // of that catalogue
  RosReaders ros_;
  bool is_merging_ = false;  // there are partners, or reports carry only what changed
  bool has_looked_ = false;  // for these, in the first report
  MergedReports merged_;
  client::ReportJudge judge_;
  std::map<TopicKind, client::RefusedMessages> refused_;  // of other topics than that of reports
  Sample<clearance_msg_Distances> report_;
  Sample<clearance_msg_Health> health_;
  Sample<clearance_msg_ZoneState> zone_;
  Sample<clearance_msg_Catalogue> catalogue_;
  Sample<clearance_msg_Separation> separation_;
  Sample<clearance_msg_Gradients> gradients_;
  bool heard_ = false;           // a report has come since there is a viewer, or since one asked
  std::int64_t watched_ns_ = 0;  // when there was one last, CLOCK_MONOTONIC
};

}  // namespace clearance::view
