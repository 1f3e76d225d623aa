// A bag as rosbag2 makes it: a folder with metadata.yaml, which names its files in their order.
#pragma once

#include <memory>
#include <vector>

#include "monitor/bags/bag.hpp"

namespace clearance {

// Without metadata.yaml, as after a crash of the recorder, the files are those of the folder, in
// the order of the numbers in their names.
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
  std::vector<std::unique_ptr<Bag>> open_;  // one after the other; topics of all stay valid
  bool readable_ = true;
  std::string error_;
};

}  // namespace clearance
