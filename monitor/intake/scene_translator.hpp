// Translates MoveIt's messages into changes of the cell.
//
// No DDS, no files and no clock. README.md says what each message means here.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "config/edit/cell_change.hpp"
#include "config/moveit/collision_matrix.hpp"
#include "config/moveit/message.hpp"
#include "config/moveit/object_entry.hpp"
#include "monitor/intake/known_scene.hpp"

namespace clearance::moveit {

// Changes to be made wholly or not at all, in this order.
struct Translation {
  std::vector<CellChange> changes = {};
  std::vector<MeshFile> files = {};  // that the changes name
  // After these changes: pairs with an exception that follows the collision matrix.
  std::set<NamePair> exceptions = {};
  // Each leaves out the object, or the list, that it names; the rest of the message counts.
  std::vector<FieldFault> refused = {};
  // Parts of the message that are in no change, in words: "link_scale of 'hand'". The caller
  // reports each of them once.
  std::vector<std::string> not_understood = {};
};

// Keeps what MoveIt keeps between messages and a cell does not: fixed frames, subframes of objects,
// the collision matrix, and the margins before a padding. To be used by one thread.
class SceneTranslator {
 public:
  explicit SceneTranslator(MeshForm meshes = MeshForm::kFile) : meshes_(meshes) {}

  // The changes assume `scene`, and the poses of now.
  [[nodiscard]] Translation translate(const CollisionObject& message, const KnownScene& scene,
                                      const PresentPoses& poses);
  [[nodiscard]] Translation translate(const AttachedCollisionObject& message,
                                      const KnownScene& scene, const PresentPoses& poses);
  [[nodiscard]] Translation translate(const PlanningScene& message, const KnownScene& scene,
                                      const PresentPoses& poses);

  // Returns the changes that have to follow those of a translation, in the same command: the
  // collision matrix is about the pairs that the changed scene watches. `present`:
  // Translation::exceptions. Empty: nothing is left to do.
  [[nodiscard]] std::vector<CellChange> exceptions(const std::set<NamePair>& watched,
                                                   const std::set<NamePair>& present) const;

  // The state as bytes, for a program of the same build. restore() returns false, and changes
  // nothing, if bytes are not of save().
  void save(std::vector<std::byte>& bytes) const;
  [[nodiscard]] bool restore(std::span<const std::byte> bytes);

 private:
  friend class MessageTranslator;
  struct Subframe {
    std::string object;
    Pose object_from_subframe;
  };
  MeshForm meshes_;
  std::map<std::string, Pose> world_from_frame_;  // fixed_frame_transforms
  std::map<std::string, Subframe> subframes_;     // by "object/subframe"
  std::map<std::string, double> padded_;          // links, with their margins before, m
  CollisionMatrix matrix_;
};

}  // namespace clearance::moveit
