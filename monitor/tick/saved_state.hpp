// The state of a monitor as bytes: for a partner of its daemon, and for recordings. A monitor of
// the same scene in the same build goes on from them with the same bits.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "monitor/inputs/scene_ids.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance {

// Saves a monitor that has taken over and not ticked yet, with the numbers of its sources at that
// time. Former scenes are those of `ids`.
inline void save_state(const SourceNumbers& numbers, const SceneIds& ids, const Monitor& monitor,
                       std::vector<std::byte>& bytes) {
  StateWriter out(bytes);
  out.put(numbers);
  ids.save_former(out);
  monitor.save(out);
}

// `ids` and `monitor` are new ones of the scene. False: the bytes do not fit it, or have values
// that no monitor of it can have.
[[nodiscard]] inline bool restore_state(std::span<const std::byte> bytes, const Scene& scene,
                                        SceneIds& ids, Monitor& monitor) {
  StateReader in(bytes);
  const SourceNumbers own = ids.sources();
  in.take(ids.sources());
  in.expect(ids.sources().is_sound(own));
  ids.restore_former(in, scene);
  if (!in.good()) return false;
  return monitor.restore(in);
}

}  // namespace clearance
