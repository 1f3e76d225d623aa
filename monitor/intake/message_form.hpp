// The form of a sensor's messages, as they state it: the frame in which they were measured, and how
// their bytes are to be read.
//
// A driver says the same in each message. Another form in mid-stream shows another camera, another
// program or a damaged header, and the numbers then mean something else. So the first form that
// was used holds for the stream. A change is stated by a restart of the daemon, or by another topic
// in a changed cell.
#pragma once

#include <cstdint>
#include <string_view>

#include "monitor/intake/camera_messages.hpp"

namespace clearance {

struct MessageForm {
  std::uint64_t frame = 0;   // a digest of the name of the frame; 0: it has none
  std::uint64_t layout = 0;  // a digest of encoding, size, steps and fields
};

// A digest of the name of a frame; 0 for none. A leading slash says nothing.
[[nodiscard]] std::uint64_t digest_of_frame(std::string_view name) noexcept;
// True if both have names, which differ.
[[nodiscard]] inline bool are_named_unlike(std::uint64_t frame, std::uint64_t other) noexcept {
  return frame != 0 && other != 0 && frame != other;
}

// `frame` is the frame in which the message was measured. The width of a cloud of one row may
// change from message to message, and so may the size of a map.
[[nodiscard]] MessageForm form_of(std::string_view frame, const DepthImage& image) noexcept;
[[nodiscard]] MessageForm form_of(std::string_view frame, const PointsView& points) noexcept;
[[nodiscard]] MessageForm form_of(std::string_view frame, const OctomapView& map) noexcept;

// The form of the first message of a stream that was used.
class FirstForm {
 public:
  // kFrameChanged or kFormChanged if a message of this form must not be used. Messages of one
  // stream have one type.
  [[nodiscard]] FrameFault refuses(const MessageForm& form) const noexcept {
    if (!any_) return FrameFault::kNoFault;
    if (are_named_unlike(form.frame, first_.frame)) return FrameFault::kFrameChanged;
    return form.layout == first_.layout ? FrameFault::kNoFault : FrameFault::kFormChanged;
  }
  // Call this for each message that is used. A first message without a frame states none.
  void use(const MessageForm& form) noexcept {
    const std::uint64_t frame = any_ && first_.frame != 0 ? first_.frame : form.frame;
    first_ = {frame, form.layout};
    any_ = true;
  }

 private:
  bool any_ = false;
  MessageForm first_;
};

}  // namespace clearance
