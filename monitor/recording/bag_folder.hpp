// A bag in a folder: metadata.yaml names its files in their order, as rosbag2 writes them.
#pragma once

#include <memory>
#include <vector>

#include "monitor/recording/bag.hpp"

namespace clearance {

// Without metadata.yaml, for example after a crash of the recorder, the files are those in the
// folder. Their order is that of the numbers in their names.
class BagFolder final : public Bag {
 public:
  explicit BagFolder(const std::filesystem::path& folder);

  [[nodiscard]] bool next(BagMessage& message) override;
  [[nodiscard]] const std::string& error() const noexcept override { return error_; }
  [[nodiscard]] bool readable() const noexcept override { return readable_; }
  [[nodiscard]] double progress() const noexcept override;

 private:
  void find_files(const std::filesystem::path& folder);

  std::vector<std::filesystem::path> files_;
  std::vector<std::unique_ptr<Bag>> open_;  // in their order; the topics of all stay valid
  bool readable_ = true;
  std::string error_;
};

}  // namespace clearance
