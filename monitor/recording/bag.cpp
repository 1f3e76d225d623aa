#include "monitor/recording/bag.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "config/text/file_bytes.hpp"
#include "monitor/files/compression.hpp"
#include "monitor/recording/bag_folder.hpp"
#include "monitor/recording/mcap_bag.hpp"
#include "monitor/recording/sqlite_bag.hpp"

namespace clearance {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kSqliteMagic = "SQLite format 3\0"sv;
constexpr std::string_view kZstdMagic = "\x28\xb5\x2f\xfd"sv;

// The first bytes of a file: fewer if it is shorter, none if it cannot be read.
std::string beginning_of(const std::filesystem::path& path) {
  const auto file = open_file(path);
  if (file == nullptr) return {};
  std::string bytes(kSqliteMagic.size(), '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  return bytes;
}

// A bag that cannot be opened.
class NoBag final : public Bag {
 public:
  explicit NoBag(std::string error) : error_(std::move(error)) {}
  [[nodiscard]] bool next(BagMessage&) override { return false; }
  [[nodiscard]] const std::string& error() const noexcept override { return error_; }
  [[nodiscard]] bool readable() const noexcept override { return false; }
  [[nodiscard]] double progress() const noexcept override { return 1.0; }

 private:
  std::string error_;
};

// Decompresses messages that rosbag2 compressed one by one. A CDR message never begins like a zstd
// frame.
class Decompressing final : public Bag {
 public:
  explicit Decompressing(std::unique_ptr<Bag> bag) : bag_(std::move(bag)) {}

  [[nodiscard]] bool next(BagMessage& message) override {
    if (!bag_->next(message)) return false;
    const auto magic = std::as_bytes(std::span(kZstdMagic));
    if (message.payload.size() < magic.size() ||
        !std::ranges::equal(message.payload.first(magic.size()), magic)) {
      return true;
    }
    // A robot's description has some MB. A message above the limit is cut off, and then does not
    // decode.
    constexpr std::size_t kLargestMessage = std::size_t{1} << 28;
    decompress(McapCompression::kZstd, message.payload, kLargestMessage, decompressed_);
    message.payload = decompressed_;
    return true;
  }
  [[nodiscard]] const std::string& error() const noexcept override { return bag_->error(); }
  [[nodiscard]] bool readable() const noexcept override { return bag_->readable(); }
  [[nodiscard]] double progress() const noexcept override { return bag_->progress(); }

 private:
  std::unique_ptr<Bag> bag_;
  std::vector<std::byte> decompressed_;
};

}  // namespace

BagFormat bag_format(const std::filesystem::path& path) {
  std::error_code none;
  if (std::filesystem::is_directory(path, none)) return BagFormat::kFolder;
  const std::string bytes = beginning_of(path);
  if (bytes == kSqliteMagic) return BagFormat::kSqlite;
  const auto mcap = std::as_bytes(std::span(kMcapMagic));
  const bool is_mcap = bytes.size() >= mcap.size() &&
                       std::ranges::equal(std::as_bytes(std::span(bytes)).first(mcap.size()), mcap);
  return is_mcap ? BagFormat::kMcap : BagFormat::kOther;
}

std::unique_ptr<Bag> open_bag(const std::filesystem::path& path) {
  switch (bag_format(path)) {
    case BagFormat::kFolder:
      return std::make_unique<BagFolder>(path);
    case BagFormat::kSqlite:
      return std::make_unique<Decompressing>(std::make_unique<SqliteBag>(path));
    case BagFormat::kMcap:
      return std::make_unique<Decompressing>(std::make_unique<McapBag>(path));
    case BagFormat::kOther:
      break;
  }
  if (beginning_of(path).starts_with(kZstdMagic)) {
    return std::make_unique<NoBag>(fmt::format(
        "{} is compressed as a whole file; decompress it beside itself, and read {} or its folder: "
        "zstd -d {}",
        path.string(), (path.parent_path() / path.stem()).string(), path.string()));
  }
  // The reader of MCAP reports files that are not MCAP or cannot be read.
  return std::make_unique<McapBag>(path);
}

}  // namespace clearance
