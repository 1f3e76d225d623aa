// Runs code that may crash, hang or exhaust memory on bytes of unknown origin, in a process of its
// own.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace clearance {

// The limits at which the kernel or the parent ends the child.
struct ChildLimits {
  std::size_t memory = std::size_t{2} << 30;  // bytes, in addition to the parent's
  unsigned cpu_s = 20;                        // processor time
  unsigned wall_s = 60;                       // the last resort, for a child that only waits
};

// The bytes that the work returned, or how the child ended without any: "crashed (Segmentation
// fault)". At most one of the two is not empty.
struct ChildWork {
  std::string bytes;
  std::string fault;
};

// Forks, runs `work` in the child and hands over its bytes. The child's standard output and error
// lead nowhere. `work` must not start threads or take locks that other threads of this process may
// hold. Never throws. Under AddressSanitizer and ThreadSanitizer, which map terabytes themselves,
// there is no limit on memory.
[[nodiscard]] ChildWork in_child(const std::function<std::string()>& work,
                                 const ChildLimits& limits = {});

}  // namespace clearance
