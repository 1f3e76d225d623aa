#include "monitor/examples/arm/bvh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace clearance::people {
namespace {

// The words of a file, one after another.
class Words {
 public:
  explicit Words(std::string_view text) : stream_(std::string(text)) {}

  std::string next() {
    std::string word;
    if (!(stream_ >> word)) throw std::invalid_argument("found the end of the BVH file too early");
    return word;
  }
  void expect(const std::string& word) {
    if (const std::string found = next(); found != word)
      throw std::invalid_argument(fmt::format("found '{}' in BVH; expected '{}'", found, word));
  }
  double number() {
    const std::string word = next();
    std::size_t used = 0;
    double value = 0.0;
    try {
      value = std::stod(word, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (used != word.size() || !std::isfinite(value))
      throw std::invalid_argument(fmt::format("found '{}' in BVH; expected a number", word));
    return value;
  }

 private:
  std::istringstream stream_;
};

void read_joint(Words& words, const std::string& name, std::size_t parent, std::size_t& channels,
                Bvh& motion) {
  const std::size_t index = motion.joints.size();
  motion.joints.push_back({.name = name, .parent = parent, .channels = {}});
  words.expect("{");
  for (std::string word = words.next(); word != "}"; word = words.next()) {
    BvhJoint& joint = motion.joints[index];
    if (word == "OFFSET") {
      for (double& coordinate : joint.offset) coordinate = words.number();
    } else if (word == "CHANNELS") {
      joint.first_channel = channels;
      for (auto left = static_cast<int>(words.number()); left > 0; --left, ++channels) {
        const std::string channel = words.next();
        const bool turns = channel.ends_with("rotation");
        if (!turns && !channel.ends_with("position"))
          throw std::invalid_argument(fmt::format("found the channel '{}' in BVH", channel));
        joint.channels.push_back(static_cast<char>(turns ? channel[0] : channel[0] - 'X' + 'x'));
      }
    } else if (word == "JOINT") {
      read_joint(words, words.next(), index, channels, motion);
    } else if (word == "End") {
      words.expect("Site");
      read_joint(words, name + "_end", index, channels, motion);
    } else {
      throw std::invalid_argument(fmt::format("found '{}' in the hierarchy of BVH", word));
    }
  }
}

// A rotation matrix, by its definition.
Mat3 turn(char axis, double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  const double c = std::cos(angle), s = std::sin(angle);
  Mat3 matrix;
  if (axis == 'X') matrix << 1, 0, 0, 0, c, -s, 0, s, c;
  if (axis == 'Y') matrix << c, 0, s, 0, 1, 0, -s, 0, c;
  if (axis == 'Z') matrix << c, -s, 0, s, c, 0, 0, 0, 1;
  return matrix;
}

}  // namespace

Bvh read_bvh(std::string_view text) {
  Words words(text);
  Bvh motion;
  std::size_t channels = 0;
  words.expect("HIERARCHY");
  words.expect("ROOT");
  read_joint(words, words.next(), 0, channels, motion);
  words.expect("MOTION");
  words.expect("Frames:");
  const double frames = words.number();
  words.expect("Frame");
  words.expect("Time:");
  motion.frame_s = words.number();
  if (!(frames >= 1.0 && frames <= 1e6 && motion.frame_s > 0.0))
    throw std::invalid_argument("found no frames in BVH, or no time between them");
  motion.frames.resize(static_cast<std::size_t>(frames));
  for (std::vector<double>& frame : motion.frames)
    for (std::size_t c = 0; c < channels; ++c) frame.push_back(words.number());
  return motion;
}

std::vector<Vec3> places_of(const Bvh& motion, std::size_t frame) {
  std::vector<Vec3> places;
  std::vector<Mat3> turns;
  for (std::size_t i = 0; i < motion.joints.size(); ++i) {
    const BvhJoint& joint = motion.joints[i];
    Vec3 offset = joint.offset;
    Mat3 rotation = Mat3::Identity();
    for (std::size_t c = 0; c < joint.channels.size(); ++c) {
      const double value = motion.frames[frame][joint.first_channel + c];
      const char channel = joint.channels[c];
      if (channel >= 'x') offset[channel - 'x'] += value;
      if (channel < 'x') rotation = rotation * turn(channel, value);
    }
    const bool is_root = i == 0;
    places.push_back(is_root ? offset : Vec3(places[joint.parent] + turns[joint.parent] * offset));
    turns.push_back(is_root ? rotation : Mat3(turns[joint.parent] * rotation));
  }
  return places;
}

Keypoints keypoints_of(const Bvh& motion, std::size_t frame, double metres) {
  const std::vector<Vec3> places = places_of(motion, frame);
  const auto at = [&](const std::string& name) {
    const auto found = std::ranges::find(motion.joints, name, &BvhJoint::name);
    if (found == motion.joints.end())
      throw std::invalid_argument(fmt::format("found no joint '{}' in BVH", name));
    const Vec3& place = places[static_cast<std::size_t>(found - motion.joints.begin())];
    return Vec3(metres * Vec3(place.z(), place.x(), place.y()));
  };
  Keypoints points;
  points.neck = at("Neck");
  points.head_top = at("Head_end");
  for (const std::size_t side : {0, 1}) {
    const std::string name = side == 0 ? "Left" : "Right";
    points.shoulder[side] = at(name + "Arm");
    points.elbow[side] = at(name + "ForeArm");
    points.wrist[side] = at(name + "Hand");
    points.fingertip[side] = at(name + "Hand_end");
    points.hip[side] = at(name + "UpLeg");
    points.knee[side] = at(name + "Leg");
    points.ankle[side] = at(name + "Foot");
    points.toe[side] = at(name + "ToeBase_end");
  }
  return points;
}

}  // namespace clearance::people
