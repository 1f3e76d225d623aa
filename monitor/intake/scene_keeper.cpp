#include "monitor/intake/scene_keeper.hpp"

#include <fmt/format.h>

#include <bit>
#include <optional>
#include <utility>
#include <variant>

#include "monitor/inputs/checksum.hpp"
#include "monitor/intake/from_wire.hpp"
#include "monitor/intake/tracked_persons.hpp"

namespace clearance::moveit {
namespace {

template <class Wire>
std::optional<Translation> translated(const RawScene& message, CdrDecoder& decoder,
                                      SceneTranslator& translator, const KnownScene& scene,
                                      const PresentPoses& poses) {
  Sample<Wire> sample;
  if (!decoder.decode(message.cdr, sample, message.bytes)) return std::nullopt;
  return translator.translate(from_wire(*sample), scene, poses);
}

}  // namespace

std::uint64_t RawScene::identity() const noexcept {
  Checksum sum;
  sum.add(type);
  sum.add(sent_ns);
  for (const char letter : topic) sum.add(letter);
  for (const std::byte byte : cdr) sum.add(byte);
  return sum.value();
}

void SceneKeeper::say(std::string sentence, Work& work) {
  if (said_.size() < kMostSaid && said_.emplace(sentence, 1).second)
    work.news.push_back(std::move(sentence));
}

// An object that is refused is missing in the scene, so a person has to hear of it each time that
// it may be another one. Beyond the most sentences that are kept, all are told.
void SceneKeeper::say_refused(std::string sentence, Work& work) {
  const auto known = said_.find(sentence);
  if (known == said_.end()) {
    if (said_.size() < kMostSaid) said_.emplace(sentence, 1);
    work.news.push_back(std::move(sentence));
  } else if (std::has_single_bit(++known->second)) {
    work.news.push_back(fmt::format("{} ({} times)", sentence, known->second));
  }
}

SceneKeeper::Work SceneKeeper::take(const RawScene& message, const Cell& cell,
                                    const PresentPoses& poses) {
  before_ = translator_;
  incomplete_.reset();
  if (message.type == RawScene::Type::kTrackedBodies)
    return {.changes = changes_by_bodies(message.cdr, message.bytes, cell.scene)};
  const KnownScene scene = known_scene(cell);
  std::optional<Translation> done;
  switch (message.type) {
    case RawScene::Type::kCollisionObject:
      done = translated<moveit_msgs_msg_dds__CollisionObject_>(message, decoder_, translator_,
                                                               scene, poses);
      break;
    case RawScene::Type::kAttachedCollisionObject:
      done = translated<moveit_msgs_msg_dds__AttachedCollisionObject_>(message, decoder_,
                                                                       translator_, scene, poses);
      break;
    case RawScene::Type::kPlanningScene:
      done = translated<moveit_msgs_msg_dds__PlanningScene_>(message, decoder_, translator_, scene,
                                                             poses);
      break;
    case RawScene::Type::kTrackedBodies:
      break;
  }
  Work work;
  if (!done) {
    say(fmt::format("{}: a message does not decode as its type, and is not used", message.topic),
        work);
    return work;
  }
  for (const FieldFault& fault : done->refused)
    say_refused(fmt::format("{}: {}: {}", message.topic, fault.field, fault.reason), work);
  for (const std::string& what : done->not_understood)
    say(fmt::format("{}: {} is not used", message.topic, what), work);
  work.changes = std::move(done->changes);
  work.files = std::move(done->files);
  if (work.changes.empty()) {
    work.changes = translator_.exceptions(scene.watched, done->exceptions);
  } else {
    incomplete_ = std::move(done->exceptions);
  }
  return work;
}

// Every object that a message may have bodies of.
std::vector<CollisionObject> SceneKeeper::objects_of(const RawScene& message) {
  const auto decoded = [&]<class Wire>(Sample<Wire> sample) {
    return decoder_.decode(message.cdr, sample, message.bytes) ? std::optional(from_wire(*sample))
                                                               : std::nullopt;
  };
  std::vector<CollisionObject> objects;
  switch (message.type) {
    case RawScene::Type::kCollisionObject:
      if (auto object = decoded(Sample<moveit_msgs_msg_dds__CollisionObject_>()))
        objects.push_back(*std::move(object));
      break;
    case RawScene::Type::kAttachedCollisionObject:
      if (auto attached = decoded(Sample<moveit_msgs_msg_dds__AttachedCollisionObject_>()))
        objects.push_back(std::move(attached->object));
      break;
    case RawScene::Type::kPlanningScene:
      if (auto scene = decoded(Sample<moveit_msgs_msg_dds__PlanningScene_>())) {
        objects = std::move(scene->collision_objects);
        for (AttachedCollisionObject& each : scene->attached)
          objects.push_back(std::move(each.object));
      }
      break;
    case RawScene::Type::kTrackedBodies:
      break;
  }
  return objects;
}

std::vector<MeshFile> SceneKeeper::files_of(const RawScene& message, const Cell& cell) {
  std::vector<CollisionObject> objects = objects_of(message);
  std::erase_if(objects, [](const CollisionObject& object) { return object.meshes.empty(); });
  std::vector<MeshFile> files;
  if (objects.empty()) return files;
  const LengthUnit unit = known_scene(cell).unit;
  for (const CollisionObject& object : objects) {
    auto body = body_of(object, unit, MeshForm::kFile);
    if (auto* made = std::get_if<Body>(&body))
      files.insert(files.end(), made->files.begin(), made->files.end());
  }
  return files;
}

std::vector<CellChange> SceneKeeper::complete(const Scene& changed) const {
  if (!incomplete_) return {};
  return translator_.exceptions(watched_pairs(changed), *incomplete_);
}

}  // namespace clearance::moveit
