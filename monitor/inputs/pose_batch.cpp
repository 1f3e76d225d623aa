#include "monitor/inputs/pose_batch.hpp"

#include <iterator>

namespace clearance {

const char* name(Reject cause) noexcept {
  static constexpr const char* kInOrder[] = {"unknown object",
                                             "not finite",
                                             "quaternion not of unit length",
                                             "time going backwards",
                                             "stamp in the future",
                                             "made for another scene",
                                             "another source sends it",
                                             "faster than it moves",
                                             "frozen, but with a twist",
                                             "elsewhere than its twist leads",
                                             "another source contradicts it",
                                             "outside its position limits",
                                             ""};
  static_assert(std::size(kInOrder) == kRejects + 1);
  return kInOrder[static_cast<std::size_t>(cause)];
}

}  // namespace clearance
