#include "tools/record/changed_cell.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <utility>

#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"

namespace clearance {

ChangedCell::ChangedCell(std::string file, const Cell* first, RecordingWriter& writer,
                         SceneChannels* scene)
    : file_(std::move(file)),
      writer_(writer),
      scene_(scene),
      revision_(first == nullptr ? 0 : first->scene.revision) {}

// While one cell is read, a later catalogue waits.
void ChangedCell::hear(const clearance_msg_Catalogue& catalogue) {
  if (file_.empty() || catalogue.scene_revision == revision_) return;
  CdrEncoder encoder;
  if (CdrDecoder().decode(encoder.encode(catalogue), wanted_) && !reading_.valid()) read();
}

void ChangedCell::read() {
  reading_ = std::async(std::launch::async, [file = file_] {
    return cell_or_errors(read_cell(file, told_on_stderr()));
  });
}

void ChangedCell::poll(std::int64_t now_ns) {
  using namespace std::chrono_literals;
  if (!reading_.valid() || reading_.wait_for(0s) != std::future_status::ready) return;
  std::optional<Cell> cell = reading_.get();
  const std::uint64_t wanted = wanted_->scene_revision;
  if (!cell || cell->scene.revision != wanted) {
    // Another change may have come meanwhile.
    if (std::exchange(tried_, wanted) != wanted) return read();
    print(
        stderr,
        "clearance-record: {} is not the cell of revision {:016x} that the daemon has changed to: "
        "the files of that one are not in the recording, unless they are those of the cell "
        "before\n",
        file_, wanted);
    return;
  }
  revision_ = wanted;
  auto kept = std::make_unique<const Cell>(*std::move(cell));
  if (const std::string why = writer_.attach(*kept); !why.empty()) {
    print(stderr, "clearance-record: the files of the changed cell are not in the recording: {}\n",
          why);
  }
  writer_.describe(*wanted_);
  if (scene_ != nullptr) scene_->change(kept->scene, now_ns);
  cell_ = std::move(kept);
}

}  // namespace clearance
