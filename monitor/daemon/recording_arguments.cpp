#include "monitor/daemon/recording_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>
#include <string>
#include <vector>

#include "config/text/sentences.hpp"
#include "monitor/app/options.hpp"

namespace clearance {
namespace {

// The catalogue stays: no recording can be read without it.
bool can_be_left_out(const Topic& topic) { return topic.kind != TopicKind::kCatalogue; }

std::string is_topic(const std::string& text) {
  std::vector<std::string> keys;
  for (const Topic& topic : kRecordedTopics | std::views::filter(can_be_left_out))
    keys.emplace_back(topic.key);
  if (std::ranges::find(keys, text) != keys.end()) return {};
  return fmt::format("found '{}'; expected {}", text, one_of(keys));
}

constexpr const char* kRecording = "Recording";

// An option with a number that may be 0.
CLI::Option* add_amount(CLI::App& app, const std::string& name, double& amount,
                        const std::string& help) {
  return app.add_option(name, amount, help)
      ->check(number_from_zero())
      ->capture_default_str()
      ->group(kRecording);
}

}  // namespace

void RecordingArguments::add_to(CLI::App& app, const std::string& prefix) {
  app.add_option(prefix + "without", without,
                 "Leave this topic out: poses, joint_states, distances, zones, health, separation "
                 "or gradients; repeatable. "
                 "Without poses and joint states nothing can be replayed")
      ->check(is_topic)
      ->allow_extra_args(false)
      ->group(kRecording);
  app.add_option(prefix + "every", pairs_every,
                 "Keep every N-th report whole, and the others without their pairs: a replay still "
                 "knows every tick")
      ->check(whole_number(1, 1'000'000'000))
      ->capture_default_str()
      ->group(kRecording);
  add_amount(app, prefix + "roll-mb", roll_mb,
             "Continue in NAME-2.mcap and so on when a file has this size, MB; 0: never");
  add_amount(app, prefix + "roll-s", roll_s, "The same when a file spans this time, s; 0: never");
  add_amount(app, prefix + "attach-mb", attach_mb,
             "Keep the files that the cell names (meshes, URDF, SRDF) if their compressed size "
             "is at most this, MB; 0: never. With them a replay needs no cell");
  app.add_flag(prefix + "uncompressed", uncompressed, "Do not compress (zstd)")->group(kRecording);
}

void RecordingArguments::add_events_to(CLI::App& app, const std::string& prefix) {
  CLI::Option* const around =
      add_amount(app, prefix + "around", around_s,
                 "Record by event: only from this time before to this time after a zone is "
                 "entered, a fault or "
                 "a command, s, in files NAME-TIME.mcap; 0: record all");
  app.add_option(prefix + "ring-mb", ring_mb,
                 "Memory for the time before an event, MB; it limits that time")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str()
      ->needs(around)
      ->group(kRecording);
  app.add_option(prefix + "keep-mb", keep_mb,
                 "Delete the oldest NAME-TIME.mcap while all of them have more than this, MB; 0: "
                 "never. A tenth of the free disk where it is not given")
      ->check(number_from_zero())
      ->needs(around)
      ->group(kRecording);
  add_amount(app, prefix + "keep-h", keep_h,
             "Delete each NAME-TIME.mcap that is older than this, h; 0: never")
      ->needs(around);
  app.add_option(prefix + "ticks", ticks_every,
                 "Keep one tick of N, with the newest poses and joints of each source, and every "
                 "change of a zone: a small recording that shows a run, and cannot be compared")
      ->check(whole_number(1, 1'000'000'000))
      ->capture_default_str()
      ->excludes(around)
      ->group(kRecording);
  app.add_option(prefix + "clouds", clouds_every,
                 "Keep every N-th frame of each camera whole, and of the others only when a tick "
                 "was shown them; 0: none. Only with all of them (1) a replay makes the same "
                 "reports")
      ->check(whole_number(0, 1'000'000'000))
      ->capture_default_str()
      ->group(kRecording);
  for (const char* const name : {"roll-mb", "roll-s"})
    around->excludes(app.get_option(prefix + name));
}

RecordingOptions RecordingArguments::options(bool overwrite) const {
  constexpr double kMost = 9e18;  // fits into 63 bits
  RecordingOptions options{
      .overwrite = overwrite,
      .compress = !uncompressed,
      .attach_bytes = static_cast<std::uint64_t>(std::ceil(std::min(attach_mb * 1e6, kMost))),
      .left_out = {},
      .pairs_every = pairs_every,
      .roll_bytes = static_cast<std::uint64_t>(std::ceil(std::min(roll_mb * 1e6, kMost))),
      .roll_ns = static_cast<std::int64_t>(std::ceil(std::min(roll_s * 1e9, kMost))),
      .ticks_every = ticks_every,
      .events = {.around_ns = static_cast<std::int64_t>(std::ceil(std::min(around_s * 1e9, kMost))),
                 .ring_bytes = static_cast<std::size_t>(ring_mb * 1e6),
                 .keep_bytes = std::nullopt,
                 .keep_ns = static_cast<std::int64_t>(std::ceil(std::min(keep_h * 3.6e12, kMost)))},
      .clouds_every = clouds_every};
  if (keep_mb)
    options.events.keep_bytes =
        static_cast<std::uint64_t>(std::ceil(std::min(*keep_mb * 1e6, kMost)));
  for (const Topic& topic : kRecordedTopics) {
    if (std::ranges::find(without, topic.key) != without.end()) options.left_out.insert(topic.kind);
  }
  return options;
}

}  // namespace clearance
