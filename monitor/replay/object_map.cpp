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
ObjectMap::ObjectMap(const Scene& scene, const clearance_msg_Catalogue* recorded) : scene_(scene) {
  if (recorded == nullptr || recorded->scene_revision == scene.revision) return;
  same_scene_ = any_ = false;
  ids_[recorded->scene_revision] = ids_of(*recorded, notes_);
}

// Notes are of the first catalogue only.
void ObjectMap::add(const clearance_msg_Catalogue& recorded) {
  std::vector<std::string> notes;
  if (!ids_.contains(recorded.scene_revision))
    ids_[recorded.scene_revision] = ids_of(recorded, notes);
}

std::vector<std::uint32_t> ObjectMap::ids_of(const clearance_msg_Catalogue& recorded,
                                             std::vector<std::string>& notes) {
  std::vector<std::uint32_t> ids;
  std::vector<std::string> names;
  for (const Object& object : scene_.objects) names.push_back(object.name);
  std::vector<bool> met(names.size(), false);
  for (std::uint32_t i = 0; i < recorded.objects._length; ++i) {
    const clearance_msg_CatalogueObject& object = recorded.objects._buffer[i];
    const auto found = std::ranges::find(names, object.name);
    const auto id = static_cast<std::uint32_t>(found - names.begin());
    // A recording of any origin may state any id.
    if (object.id >= clearance_msg_kMaxObjects) continue;
    if (object.id >= ids.size()) ids.resize(object.id + 1, kLeftOut);
    if (found == names.end()) {
      notes.push_back(
          fmt::format("object '{}' of the recording is not in the cell: its poses are left out{}",
                      object.name, did_you_mean(object.name, names)));
      continue;
    }
    met[id] = true;
    if (!scene_.objects[id].fixed) {
      ids[object.id] = id;
      any_ = true;
    } else if (!object.is_fixed) {
      notes.push_back(fmt::format(
          "object '{}' is fixed in the cell: its recorded poses are left out", names[id]));
    }
  }
  for (std::size_t id = 0; id < names.size(); ++id) {
    if (!met[id] && !scene_.objects[id].fixed) {
      notes.push_back(fmt::format(
          "object '{}' of the cell is not in the recording: its pairs stay unknown", names[id]));
    }
  }
  return ids;
}

// A batch without a revision is of the only catalogue.
bool ObjectMap::translate(PoseBatch& batch) const {
  if (same_scene_) return true;
  const bool unstated = batch.scene_revision == 0 && ids_.size() == 1;
  const auto known = unstated ? ids_.begin() : ids_.find(batch.scene_revision);
  batch.scene_revision = scene_.revision;
  if (known == ids_.end()) return false;
  const std::vector<std::uint32_t>& ids = known->second;
  std::erase_if(batch.samples, [&ids](PoseSample& sample) {
    sample.object = sample.object < ids.size() ? ids[sample.object] : kLeftOut;
    return sample.object == kLeftOut;
  });
  return true;
}

}  // namespace clearance
