#include "monitor/objects/ingest.hpp"

#include <algorithm>

namespace clearance {

Inputs initial_inputs(const Scene& scene) {
  Inputs inputs;
  for (const Object& object : scene.objects) inputs.objects.push_back(initial_state(object));
  return inputs;
}

void ingest(std::span<const PoseSample> samples, std::int64_t now_ns, const Scene& scene,
            Inputs& inputs) noexcept {
  ++inputs.cycle;
  inputs.now_ns = std::max(inputs.now_ns, now_ns);
  for (const PoseSample& sample : samples) {
    if (sample.object >= inputs.objects.size() || scene.objects[sample.object].fixed) {
      refuse(sample.object, Reject::kUnknownObject, inputs);
      continue;
    }
    TrackedObject& object = inputs.objects[sample.object];
    const auto cause = refusal(sample, object, inputs.now_ns, scene.future_limit_ns);
    if (cause) {
      refuse(sample.object, *cause, inputs);
    } else {
      accept(scene.objects[sample.object], sample, object);
    }
  }
}

void refuse(std::uint32_t object, Reject cause, Inputs& inputs) noexcept {
  const auto index = static_cast<std::size_t>(cause);
  ++inputs.rejected[index];
  if (object < inputs.objects.size()) ++inputs.objects[object].rejected[index];
}

}  // namespace clearance
