// A ROS 2 bag: the recorded messages of any topics, in one file or several. rosbag2 writes MCAP or
// SQLite 3 files in a folder with metadata.yaml.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace clearance {

// Recorders write several topics only nearly in the order of their log times. By this much, ns, a
// message may stand behind a later one.
inline constexpr std::int64_t kLogDisorderNs = 2'000'000'000;

struct BagTopic {
  std::string name;      // e.g. /joint_states
  std::string type;      // e.g. sensor_msgs/msg/JointState
  std::string encoding;  // of the messages; ROS 2 writes cdr
};

struct BagMessage {
  const BagTopic* topic = nullptr;     // valid as long as the bag
  std::int64_t log_ns = 0;             // when it was recorded
  std::span<const std::byte> payload;  // valid until the next call
};

// Only one thread may use a bag at a time. error() says what is wrong with the file.
class Bag {
 public:
  virtual ~Bag() = default;
  // Reads the next message in the order of the file, which is nearly that of log times. Returns
  // false at the end, or where the file is damaged: error() is then not empty.
  [[nodiscard]] virtual bool next(BagMessage& message) = 0;
  // A sentence with file, place and reason; empty for a sound bag.
  [[nodiscard]] virtual const std::string& error() const noexcept = 0;
  // True: the messages before the error are sound. False: this is not a bag, or not a supported
  // one.
  [[nodiscard]] virtual bool readable() const noexcept = 0;
  // The share of the bag that has been read, 0 to 1.
  [[nodiscard]] virtual double progress() const noexcept = 0;
};

// The format of a file by its first bytes, or of a folder by its content.
enum class BagFormat : std::uint8_t { kOther, kMcap, kSqlite, kFolder };
[[nodiscard]] BagFormat bag_format(const std::filesystem::path& path);

// Opens a file or a folder; never null. Messages that rosbag2 compressed one by one (zstd) are
// decompressed. A file that was compressed as a whole is refused, and the error says what to do.
[[nodiscard]] std::unique_ptr<Bag> open_bag(const std::filesystem::path& path);

}  // namespace clearance
