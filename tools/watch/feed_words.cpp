#include "tools/watch/feed_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <span>
#include <string_view>

#include "config/text/sentences.hpp"
#include "monitor/client/share_merge.hpp"
#include "monitor/interface/zone_cause.hpp"

namespace clearance::watch {
namespace {

// The daemon counts as silent when no report has arrived for this long, or for its own lease.
constexpr std::int64_t kSilentNs = 1'000'000'000;
// If this program itself was delayed, Cyclone counts the daemon as not alive for a moment. A report
// within this time shows that the daemon is alive.
constexpr std::int64_t kJustCameNs = 200'000'000;
// The time for which old reports are mentioned. It is long enough for two lines of the plain
// output.
constexpr std::int64_t kToldForNs = 2'500'000'000;

// "12:34:56", local time.
std::string time_of_day(std::int64_t realtime_ns) {
  const std::time_t seconds = realtime_ns / 1'000'000'000;
  std::tm local{};
  localtime_r(&seconds, &local);
  return fmt::format("{:02}:{:02}:{:02}", local.tm_hour, local.tm_min, local.tm_sec);
}

// This is what the daemon has told so far: it knows of joints once it has heard some.
PlacedBy placed_by(const Feed& feed, std::uint32_t object) {
  if (const clearance_msg_Health* const health = feed.health()) {
    const std::span inputs(health->inputs._buffer, health->inputs._length);
    const auto found = std::ranges::find(inputs, object, &clearance_msg_InputAge::object);
    if (found != inputs.end() && found->follows_joints) return PlacedBy::kJointStates;
  }
  const auto* const catalogue = feed.catalogue();
  if (catalogue == nullptr) return PlacedBy::kPoses;
  // The view of a sensor is one part with this name (config/cell/sensor_reader.cpp).
  if (object < catalogue->objects._length) {
    const auto& parts = catalogue->objects._buffer[object].parts;
    if (parts._length == 1 && parts._buffer[0] == std::string_view("view"))
      return PlacedBy::kFrames;
  }
  return catalogue->joints._length > 0 ? PlacedBy::kEither : PlacedBy::kPoses;
}

}  // namespace

std::string frozen(const Feed& feed, std::int64_t now_ns) {
  const std::int64_t since = now_ns - feed.last_ns();
  const std::string last =
      fmt::format("last cycle {} at {}", feed.distances().cycle, time_of_day(feed.last_ns()));
  if (feed.has_ended())
    return fmt::format("clearanced has ended {:.1f} s ago, {}", seconds_of(since), last);
  const bool not_alive = feed.publishers() == 0 && since > kJustCameNs;
  if (not_alive || since > kSilentNs) {
    return fmt::format("clearanced is silent for {:.1f} s: it died or stands still, {}",
                       seconds_of(since), last);
  }
  return {};
}

std::string not_fresh(const Feed& feed, std::int64_t now_ns) {
  if (feed.check().clocks_disagree) {
    return fmt::format("the clock of clearanced is {:.1f} s ahead of this one: ages mean nothing",
                       -seconds_of(feed.check().age_ns));
  }
  if (feed.check().is_old) {
    return fmt::format("the reports are {:.1f} s old", seconds_of(feed.check().age_ns));
  }
  const OldReports& old = feed.old_reports();
  if (old.count == 0 || now_ns - old.last_ns > kToldForNs) return {};
  return fmt::format("{} so far {} read, up to {:.1f} s", counted(old.count, "report"),
                     old.count == 1 ? "was old when it was" : "were old when they were",
                     seconds_of(old.oldest_ns));
}

std::string trouble(const Feed& feed, std::int64_t now_ns) {
  const std::string why = frozen(feed, now_ns);
  return why.empty() ? not_fresh(feed, now_ns) : why;
}

std::string inputs_of(const Feed& feed) {
  const auto* const catalogue = feed.catalogue();
  return catalogue != nullptr && catalogue->joints._length > 0 ? "inputs" : "poses";
}

std::string oldest_input(const Feed& feed) {
  const clearance_msg_Health* const health = feed.health();
  if (health == nullptr) return "oldest input";
  std::string name = "oldest input";
  std::int64_t oldest_ns = -1;
  const auto add = [&](const auto& inputs) {
    for (const auto& input : std::span(inputs._buffer, inputs._length)) {
      if constexpr (requires { input.follows_joints; }) {
        if (input.follows_joints) continue;
      }
      if (input.age_ns <= oldest_ns) continue;
      oldest_ns = input.age_ns;
      name = fmt::format("oldest input {}", input.name);
    }
  };
  add(health->inputs);
  add(health->joints);
  return name;
}

std::string cause(const Feed& feed, const clearance_msg_ZoneState& zone) {
  const auto cause = static_cast<ZoneCause>(zone.cause);
  if (cause == ZoneCause::kNear) return "";
  const std::string text =
      cause_text(cause, feed.object_name(zone.cause_object), placed_by(feed, zone.cause_object));
  return text.empty() ? text : ": " + text;
}

std::string absent_shares(const Feed& feed) {
  const clearance_msg_Health* const health = feed.health();
  if (health == nullptr) return {};
  std::string text;
  for (const clearance_msg_ShareHealth& share :
       std::span(health->shares._buffer, health->shares._length)) {
    const auto state = static_cast<client::ShareState>(share.state);
    if (state == client::ShareState::kWhole) continue;
    text += fmt::format("{}share '{}' is {}", text.empty() ? "" : ", ", share.share,
                        client::name(state));
  }
  return text;
}

// The shares of a cell report, and no program joins them.
std::string what_it_waits_for(const Feed& feed) {
  std::string names;
  for (const std::string& share : feed.shares())
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", share);
  return names.empty() ? "waiting for clearanced"
                       : fmt::format(
                             "waiting for clearance-merge, which joins the shares of a "
                             "cell (here are {}),",
                             names);
}

}  // namespace clearance::watch
