#include "monitor/daemon/recording_arguments.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>
#include <string>
#include <utility>
#include <vector>

#include "monitor/app/options.hpp"

namespace clearance {
namespace {

// The catalogue stays: no recording can be read without it.
bool can_be_left_out(const Topic& topic) { return topic.kind != TopicKind::kCatalogue; }

Check topic_of_recording() {
  std::vector<std::string> keys;
  for (const Topic& topic : kRecordedTopics | std::views::filter(can_be_left_out))
    keys.emplace_back(topic.key);
  return {one_word_of(keys).fault};
}

OptionRule with_default(std::vector<std::string> needs = {},
                        std::vector<std::string> excludes = {}) {
  return {.shows_default = true,
          .needs = std::move(needs),
          .excludes = std::move(excludes),
          .group = "Recording"};
}

}  // namespace

void RecordingArguments::add_to(CommandLine& line, const std::string& prefix) {
  line.add({
      {prefix + "without",
       &without,
       "Leave this topic out: poses, joint_states, distances, zones, health, separation or "
       "gradients; repeatable. Without poses and joint states nothing can be replayed",
       topic_of_recording(),
       {.group = "Recording"}},
      {prefix + "every", &pairs_every,
       "Keep every N-th report whole, and the others without their pairs: a replay still knows "
       "every tick",
       whole_number(1, 1'000'000'000), with_default()},
      {prefix + "roll-mb", &roll_mb,
       "Continue in NAME-2.mcap and so on when a file has this size, MB; 0: never",
       number_from_zero(), with_default()},
      {prefix + "roll-s", &roll_s, "The same when a file spans this time, s; 0: never",
       number_from_zero(), with_default()},
      {prefix + "uncompressed", &uncompressed, "Do not compress (zstd)", {.group = "Recording"}},
  });
}

void RecordingArguments::add_events_to(CommandLine& line, const std::string& prefix) {
  const std::vector<std::string> around = {prefix + "around"};
  line.add({
      {around.front(), &around_s,
       "Record by event: only from this time before to this time after a zone is entered, a fault "
       "or a command, s, in files NAME-TIME.mcap; 0: record all",
       number_from_zero(), with_default({}, {prefix + "roll-mb", prefix + "roll-s"})},
      {prefix + "ring-mb", &ring_mb, "Memory for the time before an event, MB; it limits that time",
       number_in(1.0, 1e6), with_default(around)},
      {prefix + "keep-mb",
       &keep_mb,
       "Delete the oldest NAME-TIME.mcap while all of them have more than this, MB; 0: never. A "
       "tenth of the free disk where it is not given",
       number_from_zero(),
       {.needs = around, .group = "Recording"}},
      {prefix + "keep-h", &keep_h,
       "Delete each NAME-TIME.mcap that is older than this, h; 0: never", number_from_zero(),
       with_default(around)},
      {prefix + "ticks", &ticks_every,
       "Keep one tick of N, with the newest poses and joints of each source, and every change of a "
       "zone: a small recording that shows a run, and cannot be compared",
       whole_number(1, 1'000'000'000), with_default({}, around)},
      {prefix + "clouds", &clouds_every,
       "Keep every N-th frame of each camera whole, and of the others only when a tick was shown "
       "them; 0: none. Only with all of them (1) a replay makes the same reports",
       whole_number(0, 1'000'000'000), with_default()},
  });
}

RecordingOptions RecordingArguments::options(bool overwrite) const {
  constexpr double kMost = 9e18;  // fits into 63 bits
  RecordingOptions options{
      .overwrite = overwrite,
      .compress = !uncompressed,
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
