// Makes changes of the cell from the bytes of MoveIt's messages, and of lists of tracked bodies. It
// says what it cannot use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/intake/scene_translator.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance::moveit {

// A message as it came: decoding it may take long, and has no place in a thread that takes poses.
struct RawScene {
  enum class Type : std::uint8_t {
    kCollisionObject,
    kAttachedCollisionObject,
    kPlanningScene,
    kTrackedBodies,  // without bytes: its topic is silent
  };
  Type type = Type::kPlanningScene;
  std::string topic = {};
  std::vector<std::byte> cdr = {};
  CdrBytes bytes = CdrBytes::kUnchecked;
  std::int64_t sent_ns = 0;  // by the sender's clock

  // A number by which two daemons that hear the same message know it; never 0.
  [[nodiscard]] std::uint64_t identity() const noexcept;
};

// One thread may use it. A message is one list of changes: those of take(), then complete(). Call
// take_back() if they are not done.
class SceneKeeper {
 public:
  explicit SceneKeeper(MeshForm meshes = MeshForm::kFile) : translator_(meshes) {}

  struct Work {
    std::vector<CellChange> changes = {};  // empty: nothing is to be done
    std::vector<MeshFile> files = {};      // that the changes name
    // Sentences for a person. One about what is not used comes once; one about what is refused
    // comes again, with its number, whenever that is a power of two.
    std::vector<std::string> news = {};
  };
  // The changes assume `cell`, whose text has to be Cell::yaml, and the poses of now.
  [[nodiscard]] Work take(const RawScene& message, const Cell& cell, const PresentPoses& poses);

  // Returns the changes that have to follow those of the last take(), which lead to `changed`: the
  // exceptions of the collision matrix.
  [[nodiscard]] std::vector<CellChange> complete(const Scene& changed) const;
  // The changes of the last take() were refused: what it kept is forgotten.
  void take_back() { translator_ = before_; }

  // The files that the changes of a message would name, for a daemon that does not make them.
  [[nodiscard]] std::vector<MeshFile> files_of(const RawScene& message, const Cell& cell);
  // The state between messages, for a daemon of the same build. restore() returns false, and
  // changes nothing, if bytes are not of save().
  void save(std::vector<std::byte>& bytes) const { translator_.save(bytes); }
  [[nodiscard]] bool restore(std::span<const std::byte> bytes) {
    return translator_.restore(bytes);
  }

 private:
  static constexpr std::size_t kMostSaid = 1000;
  [[nodiscard]] std::vector<CollisionObject> objects_of(const RawScene& message);
  void say(std::string sentence, Work& work);
  void say_refused(std::string sentence, Work& work);

  SceneTranslator translator_, before_;
  std::optional<std::set<NamePair>> incomplete_;  // exceptions after the changes of take()
  CdrDecoder decoder_;
  std::map<std::string, std::uint64_t> said_;  // how often
};

}  // namespace clearance::moveit
