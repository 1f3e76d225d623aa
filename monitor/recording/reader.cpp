// Passes on the MCAP messages whose schema is one of ours. The outline reads only as far as the
// summary leaves questions open.
#include "monitor/recording/reader.hpp"

#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "monitor/files/build_info.hpp"
#include "monitor/recording/writer.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {
namespace {

// Channels are recognised by type, not by topic name, which a cell may choose.
std::optional<TopicKind> kind_of(const McapChannel& channel) {
  if (channel.encoding != kCdrEncoding) return std::nullopt;
  return topic_kind(channel.schema.name);
}

// Says whether the file has messages of a kind, according to the summary. No value when there is no
// summary.
std::optional<bool> says_kind(const std::optional<McapSummary>& summary, TopicKind kind) {
  if (!summary || summary->statistics.messages == 0) return std::nullopt;
  for (const auto& [id, count] : summary->statistics.channel_messages) {
    const auto channel = summary->channels.find(id);
    if (channel != summary->channels.end() && kind_of(channel->second) == kind && count > 0) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::uint64_t number_of(const McapMap& values, const std::string& key) {
  const auto found = values.find(key);
  std::uint64_t number = 0;
  if (found != values.end())
    std::from_chars(found->second.data(), found->second.data() + found->second.size(), number);
  return number;
}

RecordingReader::RecordingReader(const std::vector<std::filesystem::path>& files,
                                 const McapWindow& window)
    : files_(files), window_(window) {
  open_.push_back(std::make_unique<McapReader>(files_.front(), window_));
}

// A file is opened when the one before has ended.
bool RecordingReader::next(RecordedMessage& message) {
  while (!next_in_file(message)) {
    if (!error().empty() || open_.size() == files_.size()) return false;
    open_.push_back(std::make_unique<McapReader>(files_[open_.size()], window_));
  }
  return true;
}

double RecordingReader::progress() const noexcept {
  return (static_cast<double>(open_.size() - 1) + open_.back()->progress()) /
         static_cast<double>(files_.size());
}

// Each channel is examined once.
bool RecordingReader::next_in_file(RecordedMessage& message) {
  McapMessage raw;
  while (refusal_.empty() && open_.back()->next(raw)) {
    auto known = channels_.find(raw.channel);
    if (known == channels_.end())
      known = channels_.emplace(raw.channel, examine(*raw.channel)).first;
    Channel& channel = known->second;
    if (!channel.kind || !refusal_.empty()) continue;
    message = {*channel.kind, static_cast<std::int64_t>(raw.log_time),
               static_cast<std::int64_t>(raw.publish_time),
               channel.change ? channel.change->apply(raw.payload) : raw.payload, raw.channel};
    return true;
  }
  return false;
}

// A schema in another language than ours cannot be compared. Such messages are taken by the name of
// their type, and those that do not decode are left out.
RecordingReader::Channel RecordingReader::examine(const McapChannel& channel) {
  Channel found{.kind = kind_of(channel), .change = {}};
  if (!found.kind || channel.schema.encoding != kIdlEncoding) return found;
  const McapSchema& ours = topic_schema(*found.kind);
  if (channel.schema.text == ours.text) return found;
  LayoutChange change(channel.schema.text, ours.text, type_of(*found.kind));
  if (!change.error().empty()) {
    const std::string build = about("build");
    refusal_ = fmt::format("{}: this build ({}) cannot read {} of the build that made it ({}): {}",
                           files_[open_.size() - 1].string(), kBuild, channel.schema.name,
                           build.empty() ? "not named" : build, change.error());
  }
  not_recorded_.insert(change.not_recorded().begin(), change.not_recorded().end());
  if (!change.is_none()) found.change = std::move(change);
  return found;
}

// Metadata written by the recorder; files of other origin have none.
std::string RecordingReader::about(const std::string& key) const {
  const McapReader& mcap = *open_.back();
  const auto about = mcap.metadata().find(std::string(kRecordingMetadata));
  if (about == mcap.metadata().end()) return {};
  const auto value = about->second.find(key);
  return value == about->second.end() ? std::string() : value->second;
}

std::uint64_t RecordingReader::joined() const {
  const auto joined = open_.back()->metadata().find(std::string(kJoinedMetadata));
  return joined == open_.back()->metadata().end() ? 0 : number_of(joined->second, "number");
}

// A file with a summary tells at once whether it has reports; without one, every message may be
// needed.
RecordingOutline outline(const std::filesystem::path& file) {
  RecordingOutline found;
  RecordingReader reader(file);
  const std::optional<bool> reports = says_kind(reader.summary(), TopicKind::kDistances);
  const std::optional<bool> catalogue = says_kind(reader.summary(), TopicKind::kCatalogue);
  found.has_reports = reports.value_or(false);
  found.has_gradients = says_kind(reader.summary(), TopicKind::kGradients).value_or(false);
  found.has_zones = says_kind(reader.summary(), TopicKind::kZones).value_or(true);
  bool first = true;
  RecordedMessage message;
  CdrDecoder decoder;
  while (reader.next(message)) {
    if (std::exchange(first, false)) {
      found.first_ns = message.log_ns;
      found.build = reader.about("build");  // stands in front
      found.cell_file = reader.about("cell_file");
      found.some_without_pairs = !reader.about("pairs_every").empty();
    }
    if (message.kind == TopicKind::kDistances) found.has_reports = true;
    if (message.kind == TopicKind::kCatalogue && !found.catalogue) {
      Sample<clearance_msg_Catalogue> sample;
      if (decoder.decode(message.cdr, sample)) found.catalogue = std::move(sample);
    }
    const bool reports_known = found.has_reports || reports.has_value();
    if (reports_known && (found.catalogue || catalogue == false)) return found;
  }
  if (!reader.readable()) found.error = reader.error();
  return found;
}

}  // namespace clearance
