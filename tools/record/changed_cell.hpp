// Keeps the cells that a daemon changes to while clearance-record listens: their files and bodies.
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "config/cell/cell.hpp"
#include "monitor/recording/writer.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "tools/record/scene_channels.hpp"

namespace clearance {

// The daemon's catalogue has the text of a changed cell, and not the files that it names. They are
// found by reading the cell file again, in a thread of its own.
class ChangedCell {
 public:
  // `file`: of the first cell; empty: none is known, and so no files. `first`: its cell. `scene`:
  // channels for 3D viewers, or null.
  ChangedCell(std::string file, const Cell* first, RecordingWriter& writer, SceneChannels* scene);

  // A catalogue was heard.
  void hear(const clearance_msg_Catalogue& catalogue);
  // Called now and then: writes what was read meanwhile.
  void poll(std::int64_t now_ns);

 private:
  void read();

  std::string file_;
  RecordingWriter& writer_;
  SceneChannels* scene_;
  std::uint64_t revision_;  // of the cell whose files are written
  std::unique_ptr<const Cell> cell_;
  Sample<clearance_msg_Catalogue> wanted_;    // the last one that was heard
  std::uint64_t tried_ = 0;                   // the revision that was not found in the file
  std::future<std::optional<Cell>> reading_;  // not valid: nothing is being read
};

}  // namespace clearance
