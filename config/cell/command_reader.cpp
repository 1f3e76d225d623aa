#include "config/cell/command_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "config/cell/object_reader.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

// Far above what a daemon ticks, and far below what would overflow.
constexpr std::int64_t kMostPairs = 100'000'000;
constexpr std::int64_t kMostBytes = 100'000'000'000;
constexpr std::int64_t kMostThreads = 64, kMostWaiting = 1000, kMostQueries = 1'000'000'000;

// The names under `from`, each once.
std::vector<std::string> read_clients(MapReader& map, const char* what, Diagnostics& diagnostics) {
  std::vector<std::string> clients;
  const YamlNode* from = map.required("from");
  if (from == nullptr) return clients;
  for (const YamlNode& item : read_list(*from, what, diagnostics)) {
    auto name = read_source(item, diagnostics);
    if (!name) continue;
    if (std::ranges::find(clients, *name) != clients.end())
      diagnostics.add(item, fmt::format("found '{}' twice; expected each client once", *name));
    clients.push_back(*std::move(name));
  }
  return clients;
}

}  // namespace

CommandSettings read_commands(const YamlNode& node, const std::filesystem::path& directory,
                              Diagnostics& diagnostics) {
  CommandSettings settings;
  MapReader map(node, "the settings of commands", diagnostics);
  settings.from = read_clients(map, "clients that may send commands", diagnostics);
  if (const YamlNode* folders = map.optional("folders")) {
    for (const YamlNode& item :
         read_list(*folders, "folders with files that commands may name", diagnostics)) {
      const auto folder = read_text(item, "the path of a folder", diagnostics);
      if (!folder) continue;
      if (folder->empty()) {
        diagnostics.add(item, "found an empty path; expected that of a folder");
        continue;
      }
      settings.folders.push_back(std::filesystem::absolute(directory / *folder).lexically_normal());
    }
  }
  map.refuse_unknown_keys();
  return settings;
}

QuestionSettings read_questions(const YamlNode& node, Diagnostics& diagnostics) {
  QuestionSettings settings;
  MapReader map(node, "the settings of questions", diagnostics);
  settings.from = read_clients(map, "clients that may ask about motions", diagnostics);
  const auto read = [&](const char* key, const char* what, std::int64_t most, auto& out) {
    const YamlNode* value = map.optional(key);
    if (value == nullptr) return;
    if (const auto number = read_integer(*value, 1, most, what, diagnostics))
      out = static_cast<std::remove_reference_t<decltype(out)>>(*number);
  };
  read("threads", "threads that answer questions", kMostThreads, settings.threads);
  read("queue", "questions of one client that may wait", kMostWaiting, settings.queue);
  read("work_limit", "distance queries for an answer", kMostQueries, settings.work_limit);
  map.refuse_unknown_keys();
  return settings;
}

AddedCapacity read_capacity(const YamlNode& node, Diagnostics& diagnostics) {
  AddedCapacity capacity;
  MapReader map(node, "the capacity", diagnostics);
  const auto read = [&](const char* key, const char* what, std::int64_t most, std::size_t& out) {
    const YamlNode* value = map.optional(key);
    if (value == nullptr) return;
    if (const auto number = read_integer(*value, 0, most, what, diagnostics))
      out = static_cast<std::size_t>(*number);
  };
  read("objects", "more objects than the cell has", kMaxObjects, capacity.objects);
  read("parts", "more parts than the cell has", kMostPairs, capacity.parts);
  read("pairs", "more pairs than the cell has", kMostPairs, capacity.pairs);
  read("bytes", "more bytes than the cell and its files have", kMostBytes, capacity.bytes);
  map.refuse_unknown_keys();
  return capacity;
}

}  // namespace clearance
