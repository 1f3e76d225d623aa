// Writes the ROS 2 outputs of a joined cell, as a daemon of the whole cell would.
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "monitor/client/shared_cell.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/publish/ros_writer.hpp"

namespace clearance::merge {

// A relay writes all outputs but `messages`, which JoinedWriter writes. After a change of the cell
// it writes nothing until another thread has read the changed cell.
class RosRelay {
 public:
  // The keys of `asked` are outputs in addition to those of the cell (monitor/app/ros_outputs.hpp).
  // `options` are those for reading the text of a changed cell. The participant outlives this.
  // Throws DdsError.
  RosRelay(Participant& participant, Cell cell, CellOptions options,
           std::vector<std::string> asked);

  // Passes the current report to the writer if its catalogue is known.
  void write(const client::SharedCell& whole);
  // The health of the joined cell, for diagnostics.
  void tell(Sample<clearance_msg_Health> health);

 private:
  // The writer refers to the cell, and ends before it.
  struct CellRelay {
    Cell cell;
    std::unique_ptr<RosWriter> writer;  // null: the cell asks for nothing
  };
  // A cell, or why it cannot be read.
  using Made = std::variant<std::unique_ptr<CellRelay>, std::string>;

  [[nodiscard]] std::unique_ptr<CellRelay> parts_of(Cell cell);
  [[nodiscard]] Made read(const std::string& yaml);
  void follow(const clearance_msg_Catalogue& catalogue);

  Participant& participant_;
  const CellOptions options_;
  const std::vector<std::string> asked_;
  Report report_;
  Mutex mutex_;
  // A writer's thread takes it.
  GUARDED_BY(mutex_) std::optional<Sample<clearance_msg_Health>> health_;
  std::unique_ptr<CellRelay> now_;
  std::uint64_t read_ = 0, unreadable_ = 0;  // revisions; 0: none
  // Threads that may wait for a disk or for DDS: the one that makes the next cell, and the one that
  // ends the last one.
  std::future<Made> making_;
  std::future<void> ending_;
};

}  // namespace clearance::merge
