// The shares of a cell whose daemons are met on the network.
#pragma once

#include <set>
#include <string>

#include "monitor/client/client.hpp"

namespace clearance::client {

class ShareNames {
 public:
  // The topics of the connection are those of the cell. Throws DdsError.
  explicit ShareNames(Connection& connection);
  ~ShareNames();
  ShareNames(const ShareNames&) = delete;
  ShareNames& operator=(const ShareNames&) = delete;

  // Takes what was met since the last time, and returns all names so far. A topic has a share's
  // name but for special characters.
  const std::set<std::string>& poll();
  [[nodiscard]] const std::set<std::string>& names() const noexcept { return names_; }
  // For a wait on several streams.
  [[nodiscard]] dds_entity_t reader() const noexcept { return reader_; }

 private:
  dds_entity_t reader_;
  std::string beginning_;  // of the topics of their distances
  std::set<std::string> names_;
};

}  // namespace clearance::client
