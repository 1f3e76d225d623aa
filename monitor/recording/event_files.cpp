#include "monitor/recording/event_files.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include "monitor/files/numbered_file.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {
namespace {

// A file may begin so often.
constexpr std::int64_t kStartEveryNs = 50'000'000;
// Files are looked at every so many calls of check(), which come once per second, and at each while
// one is written.
constexpr int kChecksALook = 60;

constexpr std::size_t kStampLength = 20;  // 20261124T104512.003Z

std::string stamp_of(std::int64_t now_ns) {
  const std::time_t seconds = now_ns / 1'000'000'000;
  return fmt::format("{:%Y%m%dT%H%M%S}.{:03}Z", fmt::gmtime(seconds), now_ns / 1'000'000 % 1000);
}

bool is_stamp(std::string_view text) {
  constexpr std::string_view kLike = "00000000T000000.000Z";
  static_assert(kLike.size() == kStampLength);
  return text.size() == kStampLength &&
         std::equal(text.begin(), text.end(), kLike.begin(), [](char c, char like) {
           return like == '0' ? c >= '0' && c <= '9' : c == like;
         });
}

// The share of the free disk that files of events may have, and of their bytes that one may have.
constexpr std::uint64_t kShareOfDisk = 10, kFilesInCap = 4;
constexpr std::uint64_t kSmallestCap = 1'000'000;

struct OldFile {
  std::filesystem::path path;
  std::string stamp;
  int number;
  std::uint64_t bytes;
  std::filesystem::file_time_type written;
};

// What stands between the prefix and the suffix of a name: a stamp, and -N in files that continue
// one or had its name taken. Returns 0 for other names.
int number_of(std::string_view name) {
  if (!is_stamp(name.substr(0, kStampLength))) return 0;
  name.remove_prefix(kStampLength);
  if (name.empty()) return 1;
  int number = 0;
  const char* const end = name.data() + name.size();
  const auto parsed = std::from_chars(name.data() + 1, end, number);
  return name[0] == '-' && parsed.ec == std::errc{} && parsed.ptr == end && number > 1 ? number : 0;
}

std::filesystem::path folder_of(const std::filesystem::path& pattern) {
  return pattern.parent_path().empty() ? "." : pattern.parent_path();
}

// The files of events, the oldest first. Links and files of other names are not among them.
std::vector<OldFile> old_files(const std::filesystem::path& pattern) {
  const std::string prefix = pattern.stem().string() + "-", suffix = pattern.extension().string();
  std::vector<OldFile> found;
  std::error_code fault;
  for (std::filesystem::directory_iterator file(folder_of(pattern), fault), end;
       !fault && file != end; file.increment(fault)) {
    const std::string name = file->path().filename().string();
    std::error_code gone;
    if (name.size() < prefix.size() + kStampLength + suffix.size() || !name.starts_with(prefix) ||
        !name.ends_with(suffix))
      continue;
    const std::string_view middle =
        std::string_view(name).substr(prefix.size(), name.size() - prefix.size() - suffix.size());
    const int number = number_of(middle);
    if (number == 0 || file->symlink_status(gone).type() != std::filesystem::file_type::regular)
      continue;
    const auto bytes = file->file_size(gone);
    if (gone) continue;
    const auto written = file->last_write_time(gone);
    if (!gone)
      found.push_back(
          {file->path(), std::string(middle.substr(0, kStampLength)), number, bytes, written});
  }
  std::ranges::sort(found, {}, [](const OldFile& one) { return std::tie(one.stamp, one.number); });
  return found;
}

}  // namespace

// Own files count as free, so that a daemon that starts again keeps as many.
std::uint64_t event_cap(const std::filesystem::path& file, const EventOptions& events) {
  if (events.keep_bytes) return *events.keep_bytes;
  std::error_code unknown;
  const auto space = std::filesystem::space(folder_of(file), unknown);
  std::uint64_t bytes = unknown ? 0 : space.available;
  for (const OldFile& old : old_files(file)) bytes += old.bytes;
  return std::max(bytes / kShareOfDisk, kSmallestCap);
}

EventFiles::EventFiles(const std::filesystem::path& file, const Topics& topics,
                       const RecordingOptions& options)
    : pattern_(file),
      file_(file),
      topics_(topics),
      options_(options),
      ring_(options.events.ring_bytes) {
  const std::uint64_t cap = event_cap(file, options.events);
  options_.events.keep_bytes = cap;
  options_.overwrite = false;
  options_.roll_bytes = (cap + kFilesInCap - 1) / kFilesInCap;
  options_.roll_ns = 0;
  const std::filesystem::path folder = folder_of(file);
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    error_ = fmt::format("no file can be made in {}: {}; expected a folder that can be written",
                         folder.string(), std::strerror(errno));
  delete_oldest();
}

std::string EventFiles::begin_scene(const Cell& cell, const clearance_msg_Catalogue& catalogue,
                                    std::int64_t log_ns) {
  const std::uint32_t number = scenes_.empty() ? 1 : scenes_.back().number + 1;
  KeptScene scene{
      number,
      attached_files(cell, options_, scenes_.empty() ? AttachedFiles{} : scenes_.back().files),
      {}};
  CdrEncoder encoder;
  static_cast<void>(CdrDecoder().decode(encoder.encode(catalogue), scene.catalogue));
  scenes_.push_back(std::move(scene));
  if (writer_) follow(number, log_ns);
  return scenes_.back().files.missing;
}

// A file goes on with another scene.
void EventFiles::follow(std::uint32_t scene, std::int64_t log_ns) {
  if (written_scene_ == scene) return;
  written_scene_ = scene;
  const auto found = std::ranges::find(scenes_, scene, &KeptScene::number);
  static_cast<void>(writer_->attach(found->files));
  writer_->catalogue(*found->catalogue, log_ns);
}

void EventFiles::write(TopicKind kind, std::int64_t log_ns, std::int64_t publish_ns,
                       std::span<const std::byte> cdr, bool repeated) {
  if (options_.left_out.contains(kind) || !ok()) return;
  keep(
      {.kind = kind, .repeated = repeated, .log_ns = log_ns, .publish_ns = publish_ns, .cdr = cdr});
  if (writer_ && (!repeated || is_first_tick_)) writer_->write(kind, log_ns, publish_ns, cdr);
}

void EventFiles::write(SideTopic topic, std::int64_t log_ns, std::int64_t stamp_ns,
                       std::span<const std::byte> cdr) {
  if (!ok()) return;
  keep({.side = topic, .log_ns = log_ns, .publish_ns = stamp_ns, .cdr = cdr});
  if (writer_) writer_->write(topic, log_ns, stamp_ns, cdr);
}

void EventFiles::keep(RingMessage message) {
  message.is_start = std::exchange(next_is_start_, false);
  if (message.is_start) started_ns_ = message.log_ns;
  message.scene = scenes_.back().number;
  ring_.put(message);
}

bool EventFiles::end_tick(std::int64_t now_ns, const std::optional<RecordedEvent>& event) {
  is_first_tick_ = false;
  const bool was_written = writer_.has_value();
  if (event && ok()) {
    if (!writer_) begin(now_ns);
    if (writer_)
      writer_->note(
          kEventMetadata,
          {{"cause", name(event->cause)}, {"what", event->what}, {"t_ns", std::to_string(now_ns)}});
    until_ns_ = now_ns + options_.events.around_ns;
  } else if (writer_ && now_ns >= until_ns_) {
    end();
  }
  if (was_written && writer_) continue_file(now_ns);
  keep_error();
  ring_.drop_before(now_ns - options_.events.around_ns);
  forget_scenes();
  next_is_start_ = next_is_start_ || now_ns - started_ns_ >= kStartEveryNs;
  return next_is_start_;
}

// The time around an event ends here.
void EventFiles::begin_anew(std::int64_t) {
  if (writer_) end();
  ring_.clear();
  next_is_start_ = true;
}

// The tick that follows is the first one of the next file, and states every zone.
void EventFiles::continue_file(std::int64_t now_ns) {
  is_first_tick_ = writer_->roll(now_ns);
  if (!is_first_tick_) return;
  next_is_start_ = true;
  delete_oldest();
}

// The scene of the first message comes first. Only the first tick of a file states every zone.
void EventFiles::begin(std::int64_t now_ns) {
  delete_oldest();
  const auto name =
      pattern_.parent_path() / fmt::format("{}-{}{}", pattern_.stem().string(), stamp_of(now_ns),
                                           pattern_.extension().string());
  writer_.emplace(first_free(name), topics_, options_);
  ++events_;
  written_scene_ = 0;
  std::optional<std::int64_t> first_tick_ns;
  ring_.for_each([&](const RingMessage& message) {
    follow(message.scene, message.log_ns);
    if (message.side)
      return writer_->write(*message.side, message.log_ns, message.publish_ns, message.cdr);
    if (message.kind == TopicKind::kDistances && !first_tick_ns) first_tick_ns = message.log_ns;
    if (message.repeated && first_tick_ns && message.log_ns > *first_tick_ns) return;
    writer_->write(message.kind, message.log_ns, message.publish_ns, message.cdr);
  });
}

void EventFiles::end() {
  writer_->close();
  keep_error();
  file_ = writer_->file();
  files_ += writer_->part();
  messages_ += writer_->messages();
  bytes_ += writer_->bytes();
  writer_.reset();
  delete_oldest();
}

// Scenes that neither the ring nor the file needs any more.
void EventFiles::forget_scenes() {
  const std::uint32_t oldest = ring_.empty() ? scenes_.back().number : ring_.front().scene;
  while (scenes_.size() > 1 && scenes_.front().number < oldest) scenes_.pop_front();
}

// The file that is being written counts and stays.
void EventFiles::delete_oldest() {
  const EventOptions& events = options_.events;
  if (*events.keep_bytes == 0 && events.keep_ns == 0) return;
  const std::vector<OldFile> files = old_files(pattern_);
  std::uint64_t total = 0;
  for (const OldFile& file : files) total += file.bytes;
  const auto now = std::filesystem::file_time_type::clock::now();
  for (const OldFile& file : files) {
    if (writer_ && file.path.filename() == writer_->file().filename()) continue;
    const bool too_many = *events.keep_bytes > 0 && total > *events.keep_bytes;
    const bool too_old =
        events.keep_ns > 0 && now - file.written > std::chrono::nanoseconds(events.keep_ns);
    std::error_code fault;
    if ((too_many || too_old) && std::filesystem::remove(file.path, fault)) total -= file.bytes;
  }
}

bool EventFiles::keep_error() {
  if (error_.empty() && writer_ && !writer_->ok()) error_ = writer_->error();
  return ok();
}

bool EventFiles::check() {
  if (++checks_ % kChecksALook == 0 || writer_) delete_oldest();
  if (writer_) writer_->check();
  return keep_error();
}

bool EventFiles::close() {
  if (writer_) end();
  return ok();
}

}  // namespace clearance
