// The keys `commands:`, `questions:` and `capacity:` of a cell: the clients that may change the
// scene of a running daemon, and the folders of their files; those that may ask about motions; the
// greatest growth of the scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace clearance {

struct CommandSettings {
  // The clients whose commands are taken; empty: there is no topic for commands.
  std::vector<std::string> from = {};
  // Meshes and cells that commands name lie below one of these, or below a folder of the daemon.
  // Absolute.
  std::vector<std::filesystem::path> folders = {};
  friend bool operator==(const CommandSettings&, const CommandSettings&) = default;
};

struct QuestionSettings {
  // The clients whose questions are answered; empty: there is no topic for questions.
  std::vector<std::string> from = {};
  std::size_t threads = 1;             // that answer questions
  std::size_t queue = 16;              // questions of one client that may wait
  std::uint64_t work_limit = 200'000;  // most distance queries for an answer
  friend bool operator==(const QuestionSettings&, const QuestionSettings&) = default;
};

// The growth for which a daemon has memory, beyond the cell that it began with.
struct AddedCapacity {
  std::size_t objects = 64;        // objects, and joint variables
  std::size_t parts = 4096;        // convex parts of objects
  std::size_t pairs = 65'536;      // watched pairs
  std::size_t bytes = 64'000'000;  // the cell's text and the files that it names
  friend bool operator==(const AddedCapacity&, const AddedCapacity&) = default;
};

}  // namespace clearance
