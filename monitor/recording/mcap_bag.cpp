#include "monitor/recording/mcap_bag.hpp"

namespace clearance {

// Two channels may have the same topic if it has several publishers.
bool McapBag::next(BagMessage& message) {
  McapMessage raw;
  if (!reader_.next(raw)) return false;
  const auto [topic, added] = topics_.try_emplace(raw.channel);
  if (added) {
    topic->second = {raw.channel->topic, raw.channel->schema.name, raw.channel->encoding};
  }
  message = {&topic->second, static_cast<std::int64_t>(raw.log_time), raw.payload};
  return true;
}

}  // namespace clearance
