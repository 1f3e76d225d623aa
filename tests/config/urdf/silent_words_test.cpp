// Nothing that a URDF or SRDF says and that could change geometry is passed over.
//
// Oracles: the same robot written twice, by rpy and by quaternions made of them in long double; and
// the robot as read before one of its words was renamed.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "config/urdf/robot_files.hpp"
#include "config/urdf/robot_model.hpp"
#include "config/urdf/urdf.hpp"
#include "tests/shared/mistake_at.hpp"
#include "tests/shared/repeats.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using test::mistake_at;
using testing::HasSubstr;

class SilentWords : public testing::Test {
 protected:
  std::variant<UrdfRobot, UrdfFaults> read(const std::string& text) {
    test::write_text(folder_ / "r.urdf", text);
    return read_urdf(folder_ / "r.urdf");
  }
  static std::string text_of(const UrdfFaults& faults) {
    std::string text;
    for (const UrdfFault& fault : faults) text += fault.text + "\n";
    return text;
  }
  std::string faults(const std::string& text) {
    const auto result = read(text);
    const auto* const found = std::get_if<UrdfFaults>(&result);
    return found == nullptr ? "" : text_of(*found);
  }
  std::string notes(const std::string& text) {
    const auto result = read(text);
    const auto* const robot = std::get_if<UrdfRobot>(&result);
    return robot == nullptr ? "refused: " + text_of(std::get<UrdfFaults>(result))
                            : fmt::format("{}", fmt::join(robot->notes, "\n"));
  }
  // A robot of one link, with this inside of <collision> or behind it.
  static std::string with(const std::string& shape, const std::string& behind = "",
                          const std::string& robot = "") {
    return "<robot name=\"r\"" + robot + ">\n<link name=\"a\"><collision>" + shape +
           "</collision>" + behind + "</link>\n</robot>\n";
  }

  test::ScratchFolder folder_;
};

const std::string kBall = "<geometry><sphere radius=\"0.1\"/></geometry>";

// One pose, as both versions write it.
struct Written {
  std::array<double, 3> xyz{}, rpy{};

  [[nodiscard]] std::string old() const {
    return fmt::format("<origin xyz=\"{}\" rpy=\"{}\"/>", fmt::join(xyz, " "), fmt::join(rpy, " "));
  }
  [[nodiscard]] std::string quaternion() const {
    std::array<long double, 3> c{}, s{};
    for (int i = 0; i < 3; ++i) {
      c[i] = std::cos(0.5L * static_cast<long double>(rpy[i]));
      s[i] = std::sin(0.5L * static_cast<long double>(rpy[i]));
    }
    const std::array<long double, 4> xyzw = {
        s[0] * c[1] * c[2] - c[0] * s[1] * s[2], c[0] * s[1] * c[2] + s[0] * c[1] * s[2],
        c[0] * c[1] * s[2] - s[0] * s[1] * c[2], c[0] * c[1] * c[2] + s[0] * s[1] * s[2]};
    return fmt::format("<origin quat_xyzw=\"{:.21g}\" xyz=\"{}\"/>", fmt::join(xyzw, " "),
                       fmt::join(xyz, " "));
  }
};

class RandomRobot {
 public:
  explicit RandomRobot(unsigned seed) : random_(seed) {}

  // Returns the robot as version 1.0 and as 1.2.
  std::pair<std::string, std::string> write() {
    add("<robot name=\"r\">\n", "<robot name=\"r\" version=\"1.2\">\n");
    const int links = whole(2, 8);
    for (int i = 0; i < links; ++i) {
      add(fmt::format("<link name=\"l{}\">", i));
      for (int shapes = whole(i == 0 ? 1 : 0, 2); shapes > 0; --shapes) add_shape();
      add("</link>\n");
    }
    for (int i = 1; i < links; ++i) add_joint(i);
    add("</robot>\n");
    return {old_, new_};
  }

 private:
  double real(double least, double most) {
    return std::uniform_real_distribution(least, most)(random_);
  }
  int whole(int least, int most) { return std::uniform_int_distribution(least, most)(random_); }
  void add(const std::string& old, const std::string& now) {
    old_ += old;
    new_ += now;
  }
  void add(const std::string& both) { add(both, both); }
  void add_origin() {
    Written at;
    for (double& each : at.xyz) each = real(-0.5, 0.5);
    for (double& each : at.rpy) each = real(-3.2, 3.2);
    add(at.old(), at.quaternion());
  }
  void add_shape() {
    add("<collision>");
    add_origin();
    const double r = real(0.01, 0.3), l = real(0.01, 0.5);
    const std::array shapes = {fmt::format("<box size=\"{} {} {}\"/>", r, l, r),
                               fmt::format("<sphere radius=\"{}\"/>", r),
                               fmt::format("<cylinder radius=\"{}\" length=\"{}\"/>", r, l),
                               fmt::format("<capsule length=\"{}\" radius=\"{}\"/>", l, r)};
    add("<geometry>" + shapes[static_cast<std::size_t>(whole(0, 3))] + "</geometry></collision>");
  }
  void add_joint(int child) {
    constexpr std::array kTypes = {"fixed", "revolute", "prismatic", "continuous"};
    add(fmt::format(
        "<joint name=\"j{0}\" type=\"{1}\"><parent link=\"l{2}\"/><child link=\"l{0}\"/>", child,
        kTypes[static_cast<std::size_t>(whole(0, 3))], whole(0, child - 1)));
    add_origin();
    add(fmt::format("<axis xyz=\"{} {} 1\"/>", real(-1, 1), real(-1, 1)));
    const std::string limit = "<limit lower=\"-1\" upper=\"1\" effort=\"3\" velocity=\"2\"";
    add(limit + "/></joint>\n",
        limit + " acceleration=\"5\" deceleration=\"7\" jerk=\"100\"/></joint>\n");
  }

  std::mt19937_64 random_;
  std::string old_, new_;
};

// The three points show every difference of two poses.
double distance_of(const Pose& a, const Pose& b) {
  double most = (a.position - b.position).norm();
  for (int i = 0; i < 3; ++i)
    most = std::max(most,
                    (transform(a, 0.3 * Vec3::Unit(i)) - transform(b, 0.3 * Vec3::Unit(i))).norm());
  return most;
}

TEST_F(SilentWords, ARobotIsTheSameWrittenAsVersion10AndAs12) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    const auto [old, now] = RandomRobot(seed).write();
    const auto a = read(old), b = read(now);
    ASSERT_TRUE(std::holds_alternative<UrdfRobot>(a)) << faults(old);
    ASSERT_TRUE(std::holds_alternative<UrdfRobot>(b)) << faults(now);
    const auto &one = std::get<UrdfRobot>(a), &other = std::get<UrdfRobot>(b);
    EXPECT_THAT(other.notes, testing::IsEmpty()) << now;
    ASSERT_EQ(one.joints.size(), other.joints.size());
    for (std::size_t i = 0; i < one.joints.size(); ++i) {
      EXPECT_LE(distance_of(pose_of(one.joints[i].parent_from_child),
                            pose_of(other.joints[i].parent_from_child)),
                1e-15)
          << now;
    }
    for (std::size_t i = 0; i < one.links.size(); ++i) {
      ASSERT_EQ(one.links[i].collisions.size(), other.links[i].collisions.size());
      for (std::size_t k = 0; k < one.links[i].collisions.size(); ++k) {
        const UrdfCollision &first = one.links[i].collisions[k],
                            &second = other.links[i].collisions[k];
        EXPECT_EQ(first.shape.index(), second.shape.index());
        EXPECT_LE(distance_of(pose_of(first.link_from_shape), pose_of(second.link_from_shape)),
                  1e-15)
            << now;
      }
    }
  }
}

TEST_F(SilentWords, AQuaternionNeedsAVersionThatHasItAndStandsAlone) {
  const std::string turned = "<origin quat_xyzw=\"0 0.6 0 0.8\"/>" + kBall;
  EXPECT_EQ(faults(with(turned, "", " version=\"1.1\"")), "");
  EXPECT_THAT(faults(with(turned)), mistake_at("r.urdf:2:35", "quat_xyzw", "1.0", "1.1"));
  EXPECT_THAT(faults(with("<origin rpy=\"0 0 0\" quat_xyzw=\"0 0.6 0 0.8\"/>" + kBall, "",
                          " version=\"1.2\"")),
              mistake_at("r.urdf:2:47", "rpy"));
  EXPECT_THAT(faults(with("<origin quat_xyzw=\"0 0.6 0 0.9\"/>" + kBall, "", " version=\"1.2\"")),
              mistake_at("r.urdf:2:35", "length"));
  EXPECT_THAT(faults(with("<origin quat_xyzw=\"0 0.6 0.8\"/>" + kBall, "", " version=\"1.1\"")),
              mistake_at("r.urdf:2:35", "4 numbers"));
  EXPECT_THAT(faults(with(kBall, "", " version=\"1.3\"")), mistake_at("r.urdf:1:17", "1.3", "1.2"));
}

TEST_F(SilentWords, WhatCouldChangeGeometryIsRefusedAtItsPlace) {
  const auto refused = [&](const std::string& shape, const std::string& place,
                           const std::string& word, const std::string& behind = "") {
    EXPECT_THAT(faults(with(shape, behind)), mistake_at("r.urdf:" + place, word)) << shape;
  };
  refused("<origin xzy=\"1 0 0\"/>" + kBall, "2:35", "'xyz'");
  refused("<origin wxyz=\"1 0 0 0\"/>" + kBall, "2:35", "'wxyz'");
  refused("<origin xyz=\"1 0 0\"/><origin xyz=\"0 0 0\"/>" + kBall, "2:48", "again");
  refused("<orign xyz=\"1 0 0\"/>" + kBall, "2:27", "'origin'");
  refused("<place><pose xyz=\"1 0 0\"/></place>" + kBall, "2:27", "<place>");
  refused("<geometry><sphere radius=\"0.1\" scale=\"2 2 2\"/></geometry>", "2:58", "'scale'");
  refused("<geometry><mesh filename=\"a.stl\"/><box size=\"1 1 1\"/></geometry>", "2:61", "<box>");
  refused("<geometry><origin xyz=\"0 0 1\"/><sphere radius=\"1\"/></geometry>", "2:37", "<origin>");
  refused("<origin>1 0 0</origin>" + kBall, "2:27", "'1 0 0'");
  refused(kBall, "2:119", "'scale'", "<!-- <link> --></link><link name=\"b\" scale=\"2\">");
  refused(kBall, "2:82", "<colision>", "<colision>" + kBall + "</colision>");
  EXPECT_THAT(faults(with(kBall, "</link><include filename=\"arm.urdf\"/><link name=\"b\">")),
              mistake_at("r.urdf:2:89", "<include>"));
}

TEST_F(SilentWords, OtherWordsAreNamedOnceAndThoseOfOtherProgramsNotAtAll) {
  const std::string noted =
      notes(with("<surface/><surface/>" + kBall,
                 "<contact><stiffness value=\"3\"/></contact><visual><what/></visual>"
                 "<drake:thing/><self_collision_checking>" +
                     kBall + "</self_collision_checking>",
                 " colour=\"red\" xmlns:drake=\"x\""));
  for (const char* word : {"<surface> in <collision> (2:27 and 1 other place)",
                           "<contact> in <link> (2:", "<drake:thing> in <link>",
                           "<self_collision_checking> in <link>", "'colour' in <robot> (1:17)"})
    EXPECT_THAT(noted, HasSubstr(word));
  EXPECT_THAT(noted, testing::Not(HasSubstr("what")));
  EXPECT_THAT(noted, testing::Not(HasSubstr("xmlns")));
  EXPECT_THAT(notes(with(kBall, "</link><origin xyz=\"0 0 0\" rpy=\"0 0 0.0\"/><link name=\"b\">")),
              HasSubstr("<origin> in <robot>"))
      << "zeros move nothing";
  EXPECT_EQ(notes(with(kBall, "<inertial><origin xyz=\"1 2 3\"/></inertial>")), "");
}

TEST_F(SilentWords, AnSrdfThatSaysAPairInOtherWordsIsRefused) {
  const auto result = [&](const std::string& text) {
    test::write_text(folder_ / "r.srdf", "<robot name=\"r\">\n" + text + "</robot>\n");
    return read_srdf(folder_ / "r.srdf");
  };
  const auto refused = result("<enable_colisions link1=\"a\" link2=\"b\"/>");
  ASSERT_TRUE(std::holds_alternative<UrdfFaults>(refused));
  EXPECT_THAT(text_of(std::get<UrdfFaults>(refused)), mistake_at("r.srdf:2:1", "enable_colisions"));
  const auto named = result("<group name=\"arm\"/><colour/>");
  ASSERT_TRUE(std::holds_alternative<Srdf>(named));
  EXPECT_THAT(std::get<Srdf>(named).notes, testing::ElementsAre(HasSubstr("<colour> in <robot>")));
}

// Everything that a reader of this file can have from it, with all digits.
std::string geometry_of(const UrdfRobot& robot) {
  std::string text;
  const auto add = [&](const auto&... values) { ((text += fmt::format("{} ", values)), ...); };
  const auto add_pose = [&](const UrdfOrigin& origin) {
    const Pose pose = pose_of(origin);
    for (const double each : pose.position) add(each);
    for (const double each : pose.orientation.coeffs()) add(each);
  };
  for (const UrdfLink& link : robot.links) {
    add(link.name);
    for (const UrdfCollision& each : link.collisions) {
      add(each.shape.index());
      add_pose(each.link_from_shape);
      if (const auto* mesh = std::get_if<UrdfMesh>(&each.shape))
        add(mesh->file, mesh->scale.x(), mesh->scale.y(), mesh->scale.z());
      if (const auto* box = std::get_if<UrdfBox>(&each.shape))
        add(box->size.x(), box->size.y(), box->size.z());
      if (const auto* ball = std::get_if<UrdfSphere>(&each.shape)) add(ball->radius);
      if (const auto* can = std::get_if<UrdfCylinder>(&each.shape)) add(can->radius, can->length);
      if (const auto* pill = std::get_if<UrdfCapsule>(&each.shape)) add(pill->radius, pill->length);
    }
  }
  for (const UrdfJoint& joint : robot.joints) {
    add(joint.type, joint.parent, joint.child);
    add_pose(joint.parent_from_child);
    if (joint.axis) add(joint.axis->x(), joint.axis->y(), joint.axis->z());
    if (joint.limit)
      add(joint.limit->lower, joint.limit->upper, joint.limit->velocity.value_or(-1));
    if (joint.mimic) add(joint.mimic->joint, joint.mimic->multiplier, joint.mimic->offset);
  }
  return text;
}

const std::string kRich = R"(<robot name="r" version="1.1">
<material name="red"><color rgba="1 0 0 1"/></material>
<link name="a"><inertial><origin xyz="1 0 0"/><mass value="1"/></inertial>
 <visual name="v"><origin xyz="0 0 1"/><geometry><box size="1 1 1"/></geometry></visual>
 <collision name="c"><origin xyz="0.1 0.2 0.3" rpy="0.4 0.5 0.6"/><geometry><box size="1 2 3"/></geometry></collision>
 <collision><origin xyz="0.1 0.2 0.3" quat_xyzw="0 0.6 0 0.8"/><geometry><mesh filename="a.stl" scale="2 2 2"/></geometry></collision></link>
<link name="b" type="arm"><collision><geometry><cylinder radius="0.1" length="0.2"/></geometry></collision>
 <collision><geometry><capsule radius="0.1" length="0.2"/></geometry></collision></link>
<link name="c"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
<joint name="j" type="revolute"><origin xyz="0.1 0.2 0.3" rpy="0.4 0.5 0.6"/><parent link="a"/><child link="b"/>
 <axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="5" velocity="2"/><dynamics damping="1"/></joint>
<joint name="k" type="continuous"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/><limit effort="5" velocity="2"/>
 <mimic joint="j" multiplier="-2" offset="0.5"/><safety_controller k_velocity="3"/></joint>
</robot>
)";

// Returns the places of all attributes' names, or of all elements', outside of the first tag.
std::vector<std::pair<std::size_t, std::size_t>> words_in(const std::string& text, bool elements) {
  std::vector<std::pair<std::size_t, std::size_t>> words;
  for (std::size_t at = 1; at < text.size(); ++at) {
    const bool begins = elements ? text[at - 1] == '<' && text[at] != '/' : text[at - 1] == ' ';
    const std::size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", at);
    if (begins && end != at && (elements || text[end] == '=')) words.emplace_back(at, end - at);
  }
  return words;
}

std::string renamed(const std::string& word, std::mt19937_64& random) {
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  const char letter = static_cast<char>('a' + below(26));
  const std::size_t at = below(word.size());
  std::string other = word;
  switch (below(5)) {
    case 0:
      return word.size() == 1 ? word + letter : other.erase(at, 1);
    case 1:
      return other.insert(at, 1, letter);
    case 2:
      other[at] = letter == other[at] ? '_' : letter;
      return other;
    case 3:
      if (word.size() > 1) std::swap(other[at], other[(at + 1) % word.size()]);
      return other == word ? word + letter : other;
    default:
      return std::string(1 + below(9), letter) + "q";
  }
}

TEST_F(SilentWords, NoRenamedAttributeChangesGeometryInSilence) {
  const std::string before = geometry_of(std::get<UrdfRobot>(read(kRich)));
  std::mt19937_64 random(57);
  const auto words = words_in(kRich, false);
  std::uint64_t refused = 0, named = 0;
  for (std::uint64_t i = 0; i < repeats(10'000); ++i) {
    const auto [at, size] = words[i % words.size()];
    const std::string other = renamed(kRich.substr(at, size), random);
    std::string text = kRich;
    const auto result = read(text.replace(at, size, other));
    const auto* const robot = std::get_if<UrdfRobot>(&result);
    refused += robot == nullptr ? 1 : 0;
    if (robot == nullptr || geometry_of(*robot) == before) continue;
    ++named;
    EXPECT_THAT(robot->notes, testing::Contains(HasSubstr("'" + other + "'"))) << text;
  }
  EXPECT_GT(refused, repeats(5'000));
  EXPECT_GT(named, 0u);
}

TEST_F(SilentWords, NoRenamedElementChangesGeometryInSilence) {
  const std::string before = geometry_of(std::get<UrdfRobot>(read(kRich)));
  std::mt19937_64 random(58);
  const auto words = words_in(kRich, true);
  for (std::uint64_t i = 0; i < repeats(2'000); ++i) {
    const auto [at, size] = words[i % words.size()];
    const std::string word = kRich.substr(at, size), other = renamed(word, random);
    if (word == "robot") continue;
    std::string text = kRich;
    const std::size_t tag_end = text.find('>', at), end = text.find("</" + word, at);
    if (text[tag_end - 1] != '/') text.replace(end + 2, size, other);
    const auto result = read(text.replace(at, size, other));
    const auto* const robot = std::get_if<UrdfRobot>(&result);
    if (robot == nullptr || geometry_of(*robot) == before) continue;
    EXPECT_THAT(robot->notes, testing::Contains(HasSubstr("<" + other + ">"))) << text;
  }
}

}  // namespace
}  // namespace clearance
