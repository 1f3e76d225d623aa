// What hands hold and no body of the cell is: elements of a camera's pictures that move rigidly
// with a link. They stay obstacles until a command attaches them.
//
// A picture counts if the link has moved since the last one that did. What nearly all of the last
// counted ones show at one place in the link's frame may still be a table along which the hand
// slides, so its places in the world have to have been seen free before. It begins near the link,
// and it has moved farther than an obstacle could that stays in the cells of the grid.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/interface/robots_seen.hpp"
#include "monitor/sensors/payload_grid.hpp"
#include "monitor/sensors/posture_history.hpp"
#include "monitor/sensors/tile_depths.hpp"

namespace clearance {

// A box in the frame of a link; of the last one while `is_held` is false.
struct UnknownPayload {
  std::uint32_t robot = 0, link = 0;
  bool is_held = false;
  std::int64_t since_ns = 0;  // the stamp of the first picture that counts
  FoundBox box;
};

class UnknownPayloads {
 public:
  // Of a depth sensor that is a witness. The scene must outlive this. Allocates all memory.
  UnknownPayloads(const Scene& scene, const Sensor& sensor);

  // A picture before anything is left out of it.
  void note(const DepthCloud& picture, const PinholeCamera& camera, const PastPose& place) noexcept;
  // The same one, without the images of bodies. The postures are placed at its stamp. Only robots
  // that are there count: beside another one, its own image would seem to be held.
  void look(const DepthCloud& cloud, const PastPose& place, const PostureHistory& postures,
            const RobotsSeen& robots, std::int64_t stamp_ns) noexcept;
  // One of each link that may hold something.
  [[nodiscard]] const std::vector<UnknownPayload>& all() const noexcept { return payloads_; }

 private:
  struct Hand {
    Hand(std::uint32_t pictures, const TileDepths& empty) : grid(pictures), before{empty, empty} {}
    Vec3 middle = Vec3::Zero();  // of its grid, in the frame of the link
    PayloadGrid grid;
    double reach = 0.0;  // what is held begins within this of `middle`, m
    struct Counted {
      std::int64_t stamp_ns = 0;
      Pose world_from_link;
    };
    std::array<Counted, PayloadGrid::kMostPictures> counted;  // the last one first
    Pose noted;                        // of the link, in the newest of `before`
    std::array<TileDepths, 2> before;  // pictures from other postures, the newest first
    std::uint32_t count = 0;           // of pictures that were counted
    std::uint32_t missing = 0;         // pictures in a row that do not have the payload
  };

  void add_hand(std::uint32_t robot, std::uint32_t link);
  void fill(Hand& hand, const DepthCloud& cloud, const PastPose& place,
            const Pose& world_from_grid) const noexcept;
  [[nodiscard]] bool is_gone(const Hand& hand, const Pose& world_from_grid) const noexcept;
  [[nodiscard]] bool is_known(const Vec3& place, const PostureHistory& postures) const noexcept;
  [[nodiscard]] bool has_moved(const Hand& hand, const Vec3& place) const noexcept;
  void look(Hand& hand, UnknownPayload& payload, const Pose& world_from_link,
            const PostureHistory& postures, std::int64_t stamp_ns) noexcept;

  const Scene& scene_;
  const Sensor& sensor_;
  std::uint32_t pictures_;
  PinholeCamera camera_;
  TileDepths now_;
  std::vector<std::uint32_t> tracked_;  // objects that are no links and whose poses come
  std::vector<Hand> hands_;             // as `payloads_`
  std::vector<UnknownPayload> payloads_;
};

// The links that may hold something: the ends of chains, or what carries fingers whose joints move
// together, and links that an object is attached to.
[[nodiscard]] std::vector<UnknownPayload> hands_of(const Scene& scene);

}  // namespace clearance
