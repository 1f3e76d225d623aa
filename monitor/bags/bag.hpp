// A bag: the messages of any topics in one file or several, as ROS 2 records them (rosbag2: MCAP,
// or SQLite 3 files, in a folder with metadata.yaml).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace clearance {

struct BagTopic {
  std::string name;      // e.g. /joint_states
  std::string type;      // e.g. sensor_msgs/msg/JointState
  std::string encoding;  // of its messages: cdr is what ROS 2 writes
};

struct BagMessage {
  const BagTopic* topic = nullptr;     // valid as long as the bag
  std::int64_t log_ns = 0;             // when it was recorded
  std::span<const std::byte> payload;  // valid until the next call
};

// Not for several threads at once. What is wrong with a file is in error().
class Bag {
 public:
  virtual ~Bag() = default;
  // The next message in the order of the file, which is nearly that of log times. False at the end,
  // or where the file stops making sense: then error() is not empty.
  [[nodiscard]] virtual bool next(BagMessage& message) = 0;
  // A sentence with file, place and reason; empty for a sound bag.
  [[nodiscard]] virtual const std::string& error() const noexcept = 0;
  // What was read before the error is sound; false: this is no bag, or one that is not taken.
  [[nodiscard]] virtual bool readable() const noexcept = 0;
  // Share that has been read, 0 to 1.
  [[nodiscard]] virtual double progress() const noexcept = 0;
};

// What a path is, by its first bytes or, of a folder, by what is in it.
enum class BagFormat : std::uint8_t { kOther, kMcap, kSqlite, kFolder };
[[nodiscard]] BagFormat bag_format(const std::filesystem::path& path);

// A file or a folder; never null. Messages that rosbag2 compressed one by one (zstd) are
// decompressed; a file that was compressed as a whole is refused with what to do.
[[nodiscard]] std::unique_ptr<Bag> open_bag(const std::filesystem::path& path);

}  // namespace clearance
