// A recorder puts its messages into a sink: one file after the other, or files by event.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "config/cell/cell.hpp"
#include "monitor/recording/recorded_event.hpp"
#include "monitor/recording/writer.hpp"

namespace clearance {

// Used by one thread. Errors are kept, as in McapWriter.
class RecordingSink {
 public:
  virtual ~RecordingSink() = default;

  // What follows is of this scene. Returns why the files that the cell names are not kept; empty:
  // they are, or there are none.
  [[nodiscard]] virtual std::string begin_scene(const Cell& cell,
                                                const clearance_msg_Catalogue& catalogue,
                                                std::int64_t log_ns) = 0;
  // `repeated`: a file needs this message only in its first tick. Topics that are left out are not
  // written.
  virtual void write(TopicKind kind, std::int64_t log_ns, std::int64_t publish_ns,
                     std::span<const std::byte> cdr, bool repeated) = 0;
  virtual void write(SideTopic topic, std::int64_t log_ns, std::int64_t stamp_ns,
                     std::span<const std::byte> cdr) = 0;
  // A tick ends, in which this happened. Returns true if a file may begin with the next tick, which
  // then states every zone.
  virtual bool end_tick(std::int64_t now_ns, const std::optional<RecordedEvent>& event) = 0;

  // The time goes back to this one. What follows stands in another file, whose first tick states
  // every zone: times in a file do not go back.
  virtual void begin_anew(std::int64_t now_ns) = 0;

  virtual bool check() = 0;
  virtual bool close() = 0;
  [[nodiscard]] virtual bool ok() const noexcept = 0;
  [[nodiscard]] virtual const std::string& error() const noexcept = 0;
  // In all files.
  [[nodiscard]] virtual std::uint64_t messages() const noexcept = 0;
  [[nodiscard]] virtual std::uint64_t bytes() const noexcept = 0;
  // The file that was begun last, and how many were.
  [[nodiscard]] virtual const std::filesystem::path& file() const noexcept = 0;
  [[nodiscard]] virtual std::uint64_t files() const noexcept = 0;
  // The events that began a file. Other files continue one.
  [[nodiscard]] virtual std::uint64_t events() const noexcept { return 0; }
};

// Everything, in one file or several.
class ContinuousFiles final : public RecordingSink {
 public:
  ContinuousFiles(const std::filesystem::path& file, const Topics& topics,
                  const RecordingOptions& options)
      : writer_(file, topics, options) {}

  std::string begin_scene(const Cell& cell, const clearance_msg_Catalogue& catalogue,
                          std::int64_t log_ns) override;
  void write(TopicKind kind, std::int64_t log_ns, std::int64_t publish_ns,
             std::span<const std::byte> cdr, bool /*repeated*/) override {
    writer_.write(kind, log_ns, publish_ns, cdr);
  }
  void write(SideTopic topic, std::int64_t log_ns, std::int64_t stamp_ns,
             std::span<const std::byte> cdr) override {
    writer_.write(topic, log_ns, stamp_ns, cdr);
  }
  bool end_tick(std::int64_t now_ns, const std::optional<RecordedEvent>& /*event*/) override {
    return writer_.roll(now_ns);
  }
  void begin_anew(std::int64_t now_ns) override { writer_.begin_anew(now_ns); }
  bool check() override { return writer_.check(); }
  bool close() override { return writer_.close(); }
  [[nodiscard]] bool ok() const noexcept override { return writer_.ok(); }
  [[nodiscard]] const std::string& error() const noexcept override { return writer_.error(); }
  [[nodiscard]] std::uint64_t messages() const noexcept override { return writer_.messages(); }
  [[nodiscard]] std::uint64_t bytes() const noexcept override { return writer_.bytes(); }
  [[nodiscard]] const std::filesystem::path& file() const noexcept override {
    return writer_.file();
  }
  [[nodiscard]] std::uint64_t files() const noexcept override { return writer_.part(); }

 private:
  RecordingWriter writer_;
};

}  // namespace clearance
