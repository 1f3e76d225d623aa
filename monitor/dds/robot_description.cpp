#include "monitor/dds/robot_description.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "config/scene/revision.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/dds/present_topics.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {
namespace {

constexpr int kPollMs = 20;
constexpr int kSayAfterPolls = 3000 / kPollMs;

std::filesystem::path cache_folder() {
  const char* const cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && *cache == '/') return std::filesystem::path(cache) / "clearance";
  const char* const home = std::getenv("HOME");
  if (home != nullptr && *home == '/') return std::filesystem::path(home) / ".cache" / "clearance";
  return std::filesystem::temp_directory_path() / "clearance";
}

}  // namespace

std::optional<std::string> wait_for_robot_description(Participant& participant,
                                                      const std::string& ros_topic,
                                                      StopSignal& stop) {
  const std::string topic = "rt" + ros_topic;
  const dds_entity_t reader = participant.ros_reader(kRosString, topic);
  PresentTopics present(participant);
  Sample<std_msgs_msg_dds__String_> sample;
  std::optional<std::string> urdf;
  for (int polls = 0; !urdf && !stop.wait(polls == 0 ? 0 : kPollMs); ++polls) {
    void* pointer = &*sample;
    dds_sample_info_t info;
    if (dds_take(reader, &pointer, &info, 1, 1) == 1 && info.valid_data && *sample->data != '\0')
      urdf = sample->data;
    present.poll();
    if (urdf || polls != kSayAfterPolls) continue;
    log_line(lines::kWaitingForDescription, topic, present.instead_on(participant.where()));
  }
  dds_delete(reader);
  return urdf;
}

// The file is written under another name and renamed, since another program may read it.
std::filesystem::path keep_robot_description(const std::string& urdf) {
  Revision revision;
  revision.add(urdf);
  const std::filesystem::path folder = cache_folder();
  const std::filesystem::path file =
      folder / fmt::format("robot_description_{:016x}.urdf", revision.value());
  const std::filesystem::path unfinished = fmt::format("{}.{}", file.string(), getpid());
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  std::ofstream out(unfinished, std::ios::binary);
  out << urdf;
  out.close();
  if (out) std::filesystem::rename(unfinished, file, fault);
  if (!out || fault) {
    throw std::runtime_error(
        fmt::format("cannot keep the robot's description as {}", file.string()));
  }
  return file;
}

}  // namespace clearance
