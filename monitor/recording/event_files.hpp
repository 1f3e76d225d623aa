// Recording by event: the last seconds are kept in memory, and a file is written only around an
// event.
#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "monitor/recording/event_ring.hpp"
#include "monitor/recording/sink.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// Name of the metadata record of each event in a file. Its keys are cause, what and t_ns.
inline constexpr std::string_view kEventMetadata = "clearance.event";

// The bytes that the files of events of this pattern may have in all, those of former runs
// included; 0: any number. It is a tenth of the disk that is free without them, where no option
// states it.
[[nodiscard]] std::uint64_t event_cap(const std::filesystem::path& file,
                                      const EventOptions& events);

// A file of an event at 10:45:12.003 UTC is called NAME-20261124T104512.003Z.mcap. It begins with
// the scene that was in force then, and the state of every zone. An event while a file is written
// prolongs it. A file that grows too large is continued in NAME-20261124T104512.003Z-2.mcap. Only
// files with such names are ever deleted, those of former runs included.
class EventFiles final : public RecordingSink {
 public:
  // `file`: its folder and NAME. The folder must exist, otherwise error() says so.
  EventFiles(const std::filesystem::path& file, const Topics& topics,
             const RecordingOptions& options);

  std::string begin_scene(const Cell& cell, const clearance_msg_Catalogue& catalogue,
                          std::int64_t log_ns) override;
  void write(TopicKind kind, std::int64_t log_ns, std::int64_t publish_ns,
             std::span<const std::byte> cdr, bool repeated) override;
  void write(SideTopic topic, std::int64_t log_ns, std::int64_t stamp_ns,
             std::span<const std::byte> cdr) override;
  bool end_tick(std::int64_t now_ns, const std::optional<RecordedEvent>& event) override;
  void begin_anew(std::int64_t now_ns) override;
  bool check() override;
  bool close() override;
  [[nodiscard]] bool ok() const noexcept override { return error_.empty(); }
  [[nodiscard]] const std::string& error() const noexcept override { return error_; }
  [[nodiscard]] std::uint64_t messages() const noexcept override {
    return messages_ + (writer_ ? writer_->messages() : 0);
  }
  [[nodiscard]] std::uint64_t bytes() const noexcept override {
    return bytes_ + (writer_ ? writer_->bytes() : 0);
  }
  [[nodiscard]] const std::filesystem::path& file() const noexcept override {
    return writer_ ? writer_->file() : file_;
  }
  [[nodiscard]] std::uint64_t files() const noexcept override {
    return files_ + (writer_ ? writer_->part() : 0);
  }
  [[nodiscard]] std::uint64_t events() const noexcept override { return events_; }

 private:
  // Both are as the scene was read. The files on the disk may change before an event.
  struct KeptScene {
    std::uint32_t number;
    AttachedFiles files;
    Sample<clearance_msg_Catalogue> catalogue;
  };

  void keep(RingMessage message);
  void continue_file(std::int64_t now_ns);
  void begin(std::int64_t now_ns);
  void end();
  void follow(std::uint32_t scene, std::int64_t log_ns);
  void forget_scenes();
  void delete_oldest();
  bool keep_error();

  std::filesystem::path pattern_, file_;  // `file_`: the last one that has ended
  Topics topics_;
  RecordingOptions options_;
  EventRing ring_;
  std::deque<KeptScene> scenes_;           // those that the ring needs; the last one is in force
  std::optional<RecordingWriter> writer_;  // while a file is written
  std::uint32_t written_scene_ = 0;
  std::int64_t until_ns_ = 0;
  bool is_first_tick_ = false;  // of a file that continues another one
  bool next_is_start_ = true;
  std::int64_t started_ns_ = 0;
  int checks_ = 0;
  std::string error_;
  std::uint64_t messages_ = 0, bytes_ = 0, files_ = 0;  // of files that have ended
  std::uint64_t events_ = 0;
};

}  // namespace clearance
