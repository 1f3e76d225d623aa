// The gradients of a report as a DDS message.
#pragma once

#include <cstdint>

#include "config/scene/scene.hpp"
#include "monitor/interface/gradient_rows.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// Lists the scene's pairs and joints once, at construction. Each report then only overwrites the
// numbers, which allocates nothing.
class GradientMessage {
 public:
  explicit GradientMessage(const Scene& scene);

  // Valid until the next call. The caller sets `daemon`. `publish_ns` is the same as in Distances.
  [[nodiscard]] clearance_msg_Gradients& of(const Report& report, std::int64_t publish_ns) noexcept;

 private:
  GradientRows rows_;
  Sample<clearance_msg_Gradients> message_;
};

}  // namespace clearance
