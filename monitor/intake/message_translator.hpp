// The work of SceneTranslator on one message.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "monitor/intake/scene_translator.hpp"

namespace clearance::moveit {

using Where = KnownObject::Where;

// Thrown and caught while one object is translated.
struct Fault {
  FieldFault fault;
};
[[noreturn]] inline void fail(std::string field, std::string reason) {
  throw Fault{{std::move(field), std::move(reason)}};
}

// Returns the value, or throws the fault with the path of the message.
template <class T>
T value_of(std::variant<T, FieldFault> result, const std::string& path) {
  if (auto* fault = std::get_if<FieldFault>(&result))
    fail(path + fault->field, std::move(fault->reason));
  return std::get<T>(std::move(result));
}

[[nodiscard]] inline Pose inverse(const Pose& pose) {
  const Eigen::Quaterniond turn = pose.orientation.conjugate();
  return {-(turn * pose.position), turn};
}

[[nodiscard]] inline bool is_same(const Pose& a, const Pose& b) {
  constexpr double kNear = 1e-6;  // m, and of a quaternion
  const Pose off = compose(inverse(a), b);
  return off.position.norm() <= kNear && off.orientation.vec().norm() <= kNear;
}

// `path` begins the names of fields in faults.
class MessageTranslator {
 public:
  MessageTranslator(SceneTranslator& kept, const KnownScene& scene, const PresentPoses& poses)
      : kept_(kept), scene_(scene), poses_(poses) {}

  void translate(const CollisionObject& message, const std::string& path);
  void translate(const AttachedCollisionObject& message, const std::string& path);
  void translate(const PlanningScene& message);
  Translation result() {
    result_.exceptions = std::move(scene_.exceptions);
    return std::move(result_);
  }

 private:
  template <class Translate>
  void guarded(const std::string& id, const Translate& translate);
  void add(const CollisionObject& message, const std::string& path);
  void append(const CollisionObject& message, const KnownObject& object, const std::string& path);
  // Adds parts in the frame of the object.
  void add_parts(KnownObject& object, const CollisionObject& message, Body body,
                 const std::string& path) const;
  void remove(const CollisionObject& message, const std::string& path);
  void move(const CollisionObject& message, const std::string& path);
  // Moves parts in the frame of the object. False: the message has no poses of shapes.
  bool move_parts(const CollisionObject& message, KnownObject& object,
                  const std::string& path) const;
  void attach_as_it_is(const AttachedCollisionObject& message, const std::string& path);
  void attach_with_shapes(const AttachedCollisionObject& message, const std::string& path);
  void append_attached(const AttachedCollisionObject& message, const std::string& path);
  void change_robot(const AttachedCollisionObject& message, const std::string& path);
  void detach(const AttachedCollisionObject& message, const std::string& path);
  void detach(const std::string& id, KnownObject& object, const std::string& path);

  std::optional<Pose> world_from(const std::string& frame) const;
  Pose frame_of(const CollisionObject& message, const std::string& path) const;
  Pose link_of(const AttachedCollisionObject& message, const std::string& path) const;
  Body body_of_message(const CollisionObject& message, const std::string& path);
  std::vector<std::string> touch_of(const AttachedCollisionObject& message);
  KnownObject* find(const std::string& id);
  void refuse_others(const std::string& id, const std::string& path);
  void put(const std::string& id, KnownObject object);
  void drop(const std::string& id);
  void forget_exceptions(const std::string& id);
  void keep_subframes(const CollisionObject& message, const std::string& path);
  void set_frames(const PlanningScene& message);
  void set_margins(const PlanningScene& message);
  void drop_gone();

  SceneTranslator& kept_;
  KnownScene scene_;  // as after the changes so far
  const PresentPoses& poses_;
  Translation result_;
};

// A fault leaves out what `translate` does with this object, and the rest goes on. `translate` may
// edit what is known only after its last check. A known object stays as it was: without its new
// body, the former one is the safer obstacle. `id`: empty, or what is about no object.
template <class Translate>
void MessageTranslator::guarded(const std::string& id, const Translate& translate) {
  const std::size_t changes = result_.changes.size(), files = result_.files.size();
  try {
    translate();
  } catch (Fault& fault) {
    result_.changes.resize(changes, RemoveObject{});
    result_.files.resize(files);
    result_.refused.push_back(std::move(fault.fault));
    if (const auto known = scene_.objects.find(id); known != scene_.objects.end())
      known->second.is_gone = false;
  }
}

}  // namespace clearance::moveit
