// A bag that is one MCAP file.
#pragma once

#include <map>

#include "monitor/files/reader.hpp"
#include "monitor/recording/bag.hpp"

namespace clearance {

class McapBag final : public Bag {
 public:
  explicit McapBag(const std::filesystem::path& file) : reader_(file) {}

  [[nodiscard]] bool next(BagMessage& message) override;
  [[nodiscard]] const std::string& error() const noexcept override { return reader_.error(); }
  [[nodiscard]] bool readable() const noexcept override { return reader_.readable(); }
  [[nodiscard]] double progress() const noexcept override { return reader_.progress(); }

 private:
  McapReader reader_;
  std::map<const McapChannel*, BagTopic> topics_;
};

}  // namespace clearance
