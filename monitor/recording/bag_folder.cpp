#include "monitor/recording/bag_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <variant>

#include "config/text/file_bytes.hpp"
#include "config/yaml/yaml_node.hpp"
#include "monitor/files/file_error.hpp"

namespace clearance {
namespace {

const YamlNode* value_of(const YamlNode& map, std::string_view key) {
  const auto entry = std::ranges::find_if(
      map.entries, [key](const YamlEntry& found) { return found.key.text == key; });
  return entry == map.entries.end() ? nullptr : &entry->value;
}

// Orders NAME_2.db3 before NAME_10.db3.
bool before(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto number_of = [](const std::filesystem::path& file) {
    const std::string stem = file.stem().string();
    std::uint64_t number = 0;
    const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
    std::from_chars(stem.data() + digits, stem.data() + stem.size(), number);
    return std::pair(number, stem);
  };
  return number_of(a) < number_of(b);
}

// The file names in `metadata`, or the reason why it cannot be used.
std::variant<std::vector<std::string>, std::string> named_files(
    const std::filesystem::path& metadata) {
  const auto text = read_bytes(metadata.string());
  if (std::holds_alternative<FileFault>(text)) return cannot_read(metadata);
  const auto parsed = parse_yaml(std::get<std::string>(text));
  if (const auto* fault = std::get_if<YamlFault>(&parsed)) {
    return fmt::format("{}:{}:{}: {}", metadata.string(), fault->line, fault->column,
                       fault->reason);
  }
  const YamlNode* const about = value_of(std::get<YamlNode>(parsed), "rosbag2_bagfile_information");
  const YamlNode* const files =
      about == nullptr ? nullptr : value_of(*about, "relative_file_paths");
  if (files == nullptr || files->items.empty()) {
    return fmt::format(
        "{} names no files; expected rosbag2_bagfile_information with relative_file_paths, as "
        "rosbag2 writes them (ros2 bag reindex makes them anew)",
        metadata.string());
  }
  std::vector<std::string> names;
  for (const YamlNode& file : files->items) names.push_back(file.text);
  return names;
}

}  // namespace

BagFolder::BagFolder(const std::filesystem::path& folder) {
  find_files(folder);
  readable_ = error_.empty();
}

namespace {

// A file that is compressed as a whole may have been decompressed beside itself.
std::filesystem::path readable_form_of(const std::filesystem::path& file) {
  std::error_code none;
  const std::filesystem::path decompressed = file.parent_path() / file.stem();
  const bool is_compressed = file.extension() == ".zstd" || file.extension() == ".zst";
  const bool is_there = std::filesystem::exists(file, none);
  return is_compressed && (!is_there || std::filesystem::exists(decompressed, none)) ? decompressed
                                                                                     : file;
}

}  // namespace

void BagFolder::find_files(const std::filesystem::path& folder) {
  const std::filesystem::path metadata = folder / "metadata.yaml";
  std::error_code none;
  if (std::filesystem::exists(metadata, none)) {
    const auto named = named_files(metadata);
    if (const auto* fault = std::get_if<std::string>(&named)) {
      error_ = *fault;
      return;
    }
    for (const std::string& name : std::get<std::vector<std::string>>(named)) {
      // Some versions of rosbag2 put the folder's name in front.
      std::filesystem::path file = folder / name;
      if (!std::filesystem::exists(file, none)) {
        file = folder / std::filesystem::path(name).filename();
      }
      files_.push_back(readable_form_of(file));
    }
    return;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".mcap" || extension == ".db3" || extension == ".zstd")
      files_.push_back(readable_form_of(entry.path()));
  }
  std::ranges::sort(files_, before);
  files_.erase(std::ranges::unique(files_).begin(), files_.end());
  if (files_.empty()) {
    error_ = fmt::format(
        "{} is no bag: it has neither metadata.yaml nor .mcap or .db3 files; expected a folder "
        "that "
        "rosbag2 wrote",
        folder.string());
  }
}

// Opens each file when the one before it has ended.
bool BagFolder::next(BagMessage& message) {
  while (error_.empty()) {
    if (!open_.empty()) {
      if (open_.back()->next(message)) return true;
      error_ = open_.back()->error();
      if (!error_.empty()) {
        readable_ = open_.size() > 1 || open_.back()->readable();
        return false;
      }
    }
    if (open_.size() == files_.size()) return false;
    open_.push_back(open_bag(files_[open_.size()]));
  }
  return false;
}

double BagFolder::progress() const noexcept {
  if (files_.empty() || open_.empty()) return 0.0;
  return (static_cast<double>(open_.size() - 1) + open_.back()->progress()) /
         static_cast<double>(files_.size());
}

}  // namespace clearance
