// Builds a table from recorded ids to the scene's ids by name, once; each batch is then translated
// by looking ids up.
#include "monitor/replay/object_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "config/text/spelling.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

// No object of the scene has this id: there are at most 4096.
constexpr std::uint32_t kLeftOut = std::numeric_limits<std::uint32_t>::max();

}  // namespace

// A recording may be replayed with a changed cell: names connect the two, since ids are places in a
// file. Everything that does not match is noted.
ObjectMap::ObjectMap(const Scene& scene, const clearance_msg_Catalogue* recorded)
    : revision_(recorded == nullptr ? scene.revision : recorded->scene_revision) {
  if (recorded == nullptr) return;
  same_scene_ = identity_ = recorded->scene_revision == scene.revision;
  if (identity_) return;
  any_ = false;
  std::vector<std::string> names;
  for (const Object& object : scene.objects) names.push_back(object.name);
  std::vector<bool> met(names.size(), false);
  for (std::uint32_t i = 0; i < recorded->objects._length; ++i) {
    const clearance_msg_CatalogueObject& object = recorded->objects._buffer[i];
    const auto found = std::ranges::find(names, object.name);
    const auto id = static_cast<std::uint32_t>(found - names.begin());
    // A recording of any origin may state any id.
    if (object.id >= clearance_msg_kMaxObjects) continue;
    if (object.id >= id_.size()) id_.resize(object.id + 1, kLeftOut);
    if (found == names.end()) {
      notes_.push_back(
          fmt::format("object '{}' of the recording is not in the cell: its poses are left out{}",
                      object.name, did_you_mean(object.name, names)));
      continue;
    }
    met[id] = true;
    if (!scene.objects[id].fixed) {
      id_[object.id] = id;
      any_ = true;
    } else if (!object.is_fixed) {
      notes_.push_back(fmt::format(
          "object '{}' is fixed in the cell: its recorded poses are left out", names[id]));
    }
  }
  for (std::size_t id = 0; id < names.size(); ++id) {
    if (!met[id] && !scene.objects[id].fixed) {
      notes_.push_back(fmt::format(
          "object '{}' of the cell is not in the recording: its pairs stay unknown", names[id]));
    }
  }
}

// Poses are left out for objects that the cell lacks or has as fixed ones.
bool ObjectMap::translate(PoseBatch& batch) const {
  if (!made_for(batch, revision_)) return false;
  if (identity_) return true;
  std::erase_if(batch.samples, [this](PoseSample& sample) {
    sample.object = sample.object < id_.size() ? id_[sample.object] : kLeftOut;
    return sample.object == kLeftOut;
  });
  return true;
}

}  // namespace clearance
