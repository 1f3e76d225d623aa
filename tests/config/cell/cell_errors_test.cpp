// Each case has one mistake, its place, and the words that report it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "tests/config/cells.hpp"

namespace clearance {
namespace {

struct Mistake {
  const char* name;
  std::string sections;  // after the three lines of cell_text(); '@' marks the mistake
  std::string error;     // the expected beginning of the error at that place
};

// One object with this shape, and another object to pair it with.
std::string with_shape(const std::string& shape, const std::string& more = "") {
  return "objects:\n  - {name: a" + more + ", " + shape +
         "}\n  - {name: b, sphere: {radius: 1}}\n" + "pairs: [{between: [a, b]}]\n";
}

// kBoxes with the mark before the rules for pairs.
std::string boxes_with_marked_rules() {
  std::string text = kBoxes;
  return text.insert(text.find("- {between"), 1, '@');
}

// A zone between 'left' and 'right' with a separation of these terms.
std::string with_separation_of(const std::string& terms) {
  return kBoxes +
         "  - {between: [left, right]}\n"
         "zones: [{name: z, between: [left, right], enter_below: 1, leave_above: 2,\n"
         "         separation: " +
         terms + "}]\n";
}
const std::string kTerms =
    "reaction_time_ms: 1, stopping_time_ms: 1, stopping_distance: 1, intrusion_distance: 1";

class CellMistake : public testing::TestWithParam<Mistake> {};

TEST_P(CellMistake, IsRefusedWhereItStands) {
  std::string text = cell_text(GetParam().sections);
  const std::size_t place = text.find('@');
  ASSERT_NE(place, std::string::npos);
  text.erase(place, 1);
  const std::size_t line_start = text.rfind('\n', place - 1) + 1;
  const auto line =
      1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n');
  const std::string where =
      "cell.yaml:" + std::to_string(line) + ":" + std::to_string(place - line_start + 1) + ": ";
  const std::string errors = errors_of(text);
  EXPECT_THAT(errors, testing::HasSubstr(where + GetParam().error));
  std::istringstream lines(errors);
  for (std::string error; std::getline(lines, error);) {
    EXPECT_THAT(error, testing::ContainsRegex("^cell.yaml:[0-9]+:[0-9]+: found .+; expected .+"));
  }
}

const Mistake kMistakes[] = {
    {"SeparationWithoutTheHumanSide", with_separation_of("@{" + kTerms + "}"),
     "found no key 'human'; expected it in the separation of a zone"},
    {"SeparationOfAThirdSide", with_separation_of("{human: @floor, " + kTerms + "}"),
     "found human: 'floor'; expected one of the two sides of the zone, 'left' or 'right'"},
    {"SeparationOfOneSide",
     kBoxes +
         "  - {between: [arm, arm]}\n"
         "zones: [{name: z, between: [arm, arm], enter_below: 1, leave_above: 2,\n"
         "         separation: @{human: arm, " +
         kTerms + "}}]\n",
     "found 'left' on both sides of the zone"},
    {"SeparationWithoutReactionTime",
     with_separation_of("@{human: left, stopping_time_ms: 1, stopping_distance: 1, "
                        "intrusion_distance: 1}"),
     "found no key 'reaction_time_ms'; expected it in the separation of a zone"},
    {"SeparationOfTwoReactions",
     with_separation_of("{human: left, controller_time_ms: @1, " + kTerms + "}"),
     "found controller_time_ms beside reaction_time_ms; expected one of them"},
    {"SeparationThatStopsBeforeItBrakes",
     with_separation_of("{human: left, reaction_time_ms: @-1, stopping_time_ms: 1, "
                        "stopping_distance: 1, intrusion_distance: 1}"),
     "found the number -1; expected the time until the robot brakes in ms"},
    {"SeparationOfAMeasuredPersonWhoStandsForEver",
     with_separation_of("{human: left, human_speed_measured: @true, " + kTerms + "}"),
     "found human_speed_measured without human_acceleration"},
    {"SeparationOfAnAccelerationFromNothing",
     with_separation_of("{human: left, human_acceleration: @1, " + kTerms + "}"),
     "found human_acceleration without human_speed_measured: true"},
    {"UnknownKey", with_shape("@spere: {radius: 1}"), "found the unknown key 'spere' in an object"},
    {"UnknownKeySuggestion", with_shape("sphere: {@raduis: 1}"),
     "found the unknown key 'raduis' in a sphere; expected 'radius' or 'centre'; did you "
     "mean 'radius'?"},
    {"RepeatedKey", "budget: 3\n@budget: 4\n" + kBoxes,
     "found the key 'budget' again; expected it once in a cell (first in line 4)"},
    {"RepeatedKeyDeepDown", with_shape("sphere: {radius: 1, @radius: 2}"),
     "found the key 'radius' again"},
    {"KeyThatIsAList", "? @[a, b]\n: 3\n" + kBoxes, "found a list of 2 as a key"},
    {"TextForNumber", with_shape("sphere: {radius: @big}"),
     "found the text 'big'; expected the radius in m"},
    {"NumberWithUnit", with_shape("sphere: {radius: @12 mm}"),
     "found the text '12 mm'; expected the radius in m, from 0 to 1000000 (a bare "
     "number: units are stated once, under 'units')"},
    {"QuotedNumber", with_shape("sphere: {radius: @\"12\"}"),
     "found the text '12'; expected the radius in m, from 0 to 1000000 (without the "
     "quotes)"},
    {"NumberForName", "objects: [{name: @12, sphere: {radius: 1}}]\n",
     "found the number 12; expected an object's name (if it is meant as text, quote it: "
     "\"12\")"},
    {"TruthForNumber", with_shape("sphere: {radius: @true}"), "found true; expected the radius"},
    {"NothingForNumber", with_shape("sphere: {radius: @}"), "found nothing; expected the radius"},
    {"MapForNumber", with_shape("sphere: {radius: @{m: 1}}"), "found a map; expected the radius"},
    {"NaN", with_shape("sphere: {radius: @.nan}"),
     "found the number .nan, which is not a finite number"},
    {"Infinity", with_shape("box: {size: [1, 1, @.inf]}"),
     "found the number .inf, which is not a finite number"},
    {"TooLargeForADouble", with_shape("box: {size: [1, 1, @1e999]}"),
     "found the number 1e999, which is not a finite number"},
    {"FartherThanAnyCell", with_shape("box: {size: [1, 1, @1e7]}"),
     "found the number 1e7; expected a length in m, more than 0 and at most 1000000\n"},
    {"ZeroBox", with_shape("box: {size: [1, @0, 1]}"),
     "found the number 0; expected a length in m, more than 0 and at most 1000000\n"},
    {"NegativeRadius", with_shape("capsule: {from: [0, 0, 0], to: [0, 0, 1], radius: @-0.1}"),
     "found the number -0.1; expected the radius"},
    {"CapsuleWithoutLength", with_shape("capsule: @{from: [0, 0, 1], to: [0, 0, 1], radius: 1}"),
     "found a capsule that is not a solid convex body (the segment's two ends are the same point); "
     "expected two different ends"},
    {"FlatPrism", with_shape("prism: @{base: [[0, 0], [1, 0], [0, 1]], z: [1, 1]}"),
     "found a prism that is not a solid convex body (the prism's low end must be finite and below "
     "its high end); expected a base of at least three vertices"},
    {"PrismOverALine", with_shape("prism: @{base: [[0, 0], [1, 0], [2, 0]], z: [0, 1]}"),
     "found a prism that is not a solid convex body"},
    {"FlatVertices",
     with_shape("polyhedron: @{vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]}"),
     "found a polyhedron that is not a solid convex body (the points enclose no volume: all 4 lie "
     "in "
     "one plane); expected at least four vertices, not all in one plane"},
    {"NoVertices", with_shape("polyhedron: @{vertices: []}"),
     "found a polyhedron that is not a solid convex body"},
    {"EmptyIntersection",
     with_shape("polyhedron: @{half_spaces: [{normal: [1, 0, 0], offset: 0}, {normal: [-1, 0, 0], "
                "offset: -1}]}",
                ", fixed: true"),
     "found a polyhedron that is not a solid convex body"},
    {"ZeroNormal", with_shape("half_space: {normal: @[0, 0, 0], offset: 1}", ", fixed: true"),
     "found only zeros; expected the outward normal, a direction"},
    {"OffsetAndThrough",
     with_shape("half_space: @{normal: [0, 0, 1], offset: 1, through: [0, 0, 0]}", ", fixed: true"),
     "found both of 'offset' and 'through'; expected one of the two"},
    {"NeitherOffsetNorThrough", with_shape("half_space: @{normal: [0, 0, 1]}", ", fixed: true"),
     "found neither of 'offset' and 'through'"},
    {"UnboundedMovingHalfSpace", with_shape("half_space: @{normal: [0, 0, 1], offset: 0}"),
     "found an unbounded half_space in a moving object; expected a bounded shape, or fixed: "
     "true"},
    {"UnboundedMovingPolyhedron",
     with_shape("polyhedron: @{half_spaces: [{normal: [1, 0, 0], offset: 0}, {normal: [0, 1, 0], "
                "offset: 0}]}"),
     "found an unbounded polyhedron in a moving object"},
    {"EllipsoidOfTwoAxes", with_shape("ellipsoid: {semi_axes: @[1, 2]}"),
     "found a list of 2; expected the ellipsoid's semi-axes in m, a list of 3 numbers"},
    {"FlatCylinder", with_shape("cylinder: {radius: 1, length: @0}"),
     "found the number 0; expected the length in m"},
    {"TruncatedConeOfTwoPoints",
     with_shape("truncated_cone: @{lower_radius: 0, upper_radius: 0, length: 1}"),
     "found a truncated_cone that is not a solid convex body"},
    {"NegativeRounding", with_shape("box: {size: [1, 1, 1], rounding: @-1}"),
     "found the number -1; expected the radius around the body in m"},
    {"TwoShapes", with_shape("box: {size: [1, 1, 1]}, sphere: @{radius: 1}"),
     "found 'sphere' beside 'box'; expected one shape a part"},
    {"NoShape", "objects:\n  - @{name: a}\npairs: []\n",
     "found no shape; expected one of 'box', 'sphere'"},
    {"ShapeBesideParts", with_shape("parts: [{sphere: {radius: 1}}], box: @{size: [1, 1, 1]}"),
     "found 'box' of an object that has 'parts'"},
    {"NoParts", with_shape("parts: @[]"), "found an empty list; expected at least one part"},
    {"RepeatedPartName",
     with_shape("parts: [{name: p, sphere: {radius: 1}}, {name: @p, sphere: {radius: 2}}]"),
     "found the part name 'p' again"},
    {"MissingMesh", with_shape("mesh: {file: @nowhere.stl}"),
     "found a mesh file that cannot be used: 'nowhere.stl' cannot be opened"},
    {"PoseOfAMovingObject", with_shape("sphere: {radius: 1}, pose: @{xyz: [0, 0, 1]}"),
     "found 'pose' of a moving object; expected it of fixed objects"},
    {"SpeedOfAFixedObject", with_shape("sphere: {radius: 1}", ", fixed: true, max_speed: @1"),
     "found 'max_speed' of a fixed object"},
    {"TwoOrientations",
     with_shape("sphere: {radius: 1}",
                ", fixed: true, pose: {rpy: [0, 0, 0], quaternion: @[0, 0, 0, 1]}"),
     "found a quaternion beside rpy"},
    {"QuaternionOfLengthTwo",
     with_shape("sphere: {radius: 1}", ", fixed: true, pose: {quaternion: @[0, 0, 0, 2]}"),
     "found a quaternion of length 2.0"},
    {"NegativeMargin", with_shape("sphere: {radius: 1}, margin: @-1"),
     "found the number -1; expected the margin in m, from 0 to 1000000"},
    {"SourceOfAFixedObject", with_shape("sphere: {radius: 1}", ", fixed: true, source: @arm"),
     "found 'source' of a fixed object"},
    {"LongSource", with_shape("sphere: {radius: 1}, source: @a_name_of_more_than_thirty_two_bytes"),
     "found a source's name of 36 bytes; expected at most 32"},
    {"NumberedSource", with_shape("sphere: {radius: 1}, source: @'/joint_states#2'"),
     "found the source '/joint_states#2'; expected a name that does not end in '#' and a number"},
    {"ZeroFrozenLimit", with_shape("sphere: {radius: 1}, frozen_limit_ms: @0"),
     "found the number 0; expected the frozen limit in ms, more than 0 and at most 86400000"},
    {"ZeroAgeLimit", with_shape("sphere: {radius: 1}, age_limit_ms: @0"),
     "found the number 0; expected the age limit in ms, more than 0 and at most 86400000"},
    {"FractionalBudget", "budget: @1.5\n" + kBoxes,
     "found the number 1.5; expected distance queries a tick, a whole number from 1 to 1000000000"},
    {"BudgetTooSmallToRefresh", "refresh_s: 0.001\nbudget: @1\n" + kBoxes,
     "found a budget of 1; expected at least 2 queries a tick, which refreshing every pair within "
     "refresh_s takes (ticks: 1): raise budget or refresh_s"},
    {"InfiniteSpeed", with_shape("sphere: {radius: 1}, max_speed: @.inf"),
     "found the number .inf, which is not a finite number; expected the largest speed of any point "
     "of the object in m/s, more than 0 and at most 1000000"},
    {"InfiniteRefresh", "refresh_s: @.inf\n" + kBoxes,
     "found the number .inf, which is not a finite number; expected seconds within which every "
     "pair "
     "is refreshed, from 0.001 to 1000000"},
    {"NumberForFlag", with_shape("sphere: {radius: 1}, fixed: @1"),
     "found the number 1; expected true or false"},
    {"NameTooLong", "objects: [{name: @" + std::string(65, 'x') + ", sphere: {radius: 1}}]\n",
     "found the text 'xxx"},
    {"NameWithComma", "objects: [{name: @\"a,b\", sphere: {radius: 1}}]\n",
     "found the text 'a,b'; expected an object's name: 1 to 64 bytes without commas"},
    {"NoObjects", "objects: @[]\npairs: []\n", "found an empty list; expected at least one object"},
    {"ObjectsAreNoList", "objects: @{a: 1}\npairs: []\n",
     "found a map; expected a list of objects"},
    {"UnknownGroup", kBoxes + "  - {between: [@amr, still]}\n",
     "found the unknown name 'amr'; expected a group or an object; did you mean 'arm'?"},
    {"UnusedGroup",
     "objects: [{name: a, groups: [arm], sphere: {radius: 1}}, {name: @b, groups: [amr], sphere: "
     "{radius: 1}}]\npairs: [{between: [arm, b]}]\n",
     "found the group 'amr' of object 'b', which nothing under 'pairs', 'allowed_collisions', "
     "'zones' or 'contacts' names; expected every group to be used; did you mean 'arm'?"},
    {"GroupNamedAsAnObject",
     "objects: [{name: @a, groups: [b], sphere: {radius: 1}}, {name: b, sphere: {radius: "
     "1}}]\npairs: [{between: [a, b]}]\n",
     "found the group 'b' of object 'a'; expected another name"},
    {"RepeatedGroup", with_shape("sphere: {radius: 1}, groups: [g, @g]"),
     "found the group 'g' again"},
    {"UnwatchedObject",
     "objects: [{name: a, sphere: {radius: 1}}, {name: b, sphere: {radius: 1}}, {name: @c, sphere: "
     "{radius: 1}}]\npairs: [{between: [a, b]}]\n",
     "found the object 'c', which no rule under 'pairs' covers"},
    {"PairOfFixedObjects", kBoxes + "  - @{between: [still, floor]}\n",
     "found no pair between 'still' and 'floor'"},
    {"PairWithItself", kBoxes + "  - @{between: [left, left]}\n",
     "found no pair between 'left' and 'left'"},
    {"ThreeSides", kBoxes + "  - {between: @[left, right, floor]}\n",
     "found a list of 3; expected two groups or objects: [A, B]"},
    {"ExceptionWithoutReason", kBoxes + "allowed_collisions: [@{between: [left, floor]}]\n",
     "found no key 'reason'; expected it in an allowed collision"},
    {"ExceptionWithEmptyReason",
     kBoxes + "allowed_collisions: [{between: [left, floor], reason: @\"\"}]\n",
     "found an empty reason"},
    {"ExceptionForUnwatchedPair",
     kBoxes + "allowed_collisions: [@{between: [left, right], reason: x}]\n",
     "found an exception that changes nothing: 'left' against 'right' is not watched "
     "anyway, since no rule under 'pairs' covers it"},
    {"ExceptionTwice",
     kBoxes +
         "allowed_collisions:\n  - {between: [left, floor], reason: x}\n  - @{between: [floor, "
         "left], reason: x}\n",
     "found an exception that changes nothing: 'floor' against 'left' is not watched anyway, "
     "since line 11 has already allowed it"},
    {"ExceptionForItself", kBoxes + "allowed_collisions: [@{between: [left, left], reason: x}]\n",
     "found an exception that changes nothing: 'left' against 'left' is not watched anyway, since "
     "an object has no pair with itself"},
    {"EveryPairAllowed",
     boxes_with_marked_rules() + "allowed_collisions: [{between: [arm, still], reason: x}]\n",
     "found every pair allowed to touch"},
    {"ZoneOverUnwatchedPair",
     kBoxes + "zones: [@{name: z, between: [arm, arm], enter_below: 1, leave_above: 1}]\n",
     "found a zone over 1 pair that is not watched, such as 'left' against 'right'"},
    {"ZoneOverAllowedPairsOnly",
     kBoxes + "allowed_collisions: [{between: [left, floor], reason: x}]\nzones: [@{name: z, "
              "between: [left, floor], enter_below: 1, leave_above: 1}]\n",
     "found a zone over no pair"},
    {"ZoneNameTwice",
     kBoxes + "zones:\n  - {name: z, between: [left, floor], enter_below: 1, leave_above: 1}\n  - "
              "{name: @z, between: [right, floor], enter_below: 1, leave_above: 1}\n",
     "found the zone name 'z' again"},
    {"ZoneWithNegativeHysteresis",
     kBoxes + "zones: [{name: z, between: [left, floor], enter_below: 2, leave_above: @1}]\n",
     "found leave_above: 1 below enter_below: 2"},
    {"ZoneWithoutHysteresis",
     kBoxes + "zones: [@{name: z, between: [left, floor], enter_below: 2}]\n",
     "found no key 'leave_above'"},
    {"DomainTooLarge", "dds: {domain: @233}\n" + kBoxes,
     "found the number 233; expected a DDS domain, a whole number from 0 to 232"},
    {"PartitionWithWildcard", "dds: {partition: @\"a*\"}\n" + kBoxes,
     "found the text 'a*'; expected a partition"},
    {"TopicWithBlank", "dds: {topics: {poses: @a b}}\n" + kBoxes,
     "found the text 'a b'; expected a topic's name"},
    {"TopicTwice", "dds: {topics: @{poses: clearance/health}}\n" + kBoxes,
     "found the topic 'clearance/health' for both 'poses' and 'health'"},
    {"RateZero", "dds: {domain: 1}\n@rate_hz: 0\n" + kBoxes, "found the key 'rate_hz' again"},
    {"SimulatedFixedObject", kBoxes + "simulation: {movers: [{object: @floor}]}\n",
     "found the fixed object 'floor'; expected a moving one"},
    {"SimulatedTwice", kBoxes + "simulation: {movers: [{object: left}, {object: @left}]}\n",
     "found the object 'left' again"},
    {"SimulatedUnknown", kBoxes + "simulation: {movers: [{object: @lefd}]}\n",
     "found the unknown object 'lefd'; expected one of the cell's; did you mean 'left'?"},
    {"SimulatedFrameTwice",
     "ros2: {world_frame: map}\n" + kBoxes +
         "simulation: {movers: [{frame: mast}, {frame: @mast}]}\n",
     "found the frame 'mast' again"},
    {"SimulatedFrameAndObject",
     "ros2: {world_frame: map}\n" + kBoxes +
         "simulation: {movers: [{frame: mast, object: @left}]}\n",
     "found 'object' beside 'frame' of a mover"},
    {"JointType", kBoxes + "simulation: {chains: [{name: c, joints: [{type: @ball}]}]}\n",
     "found the text 'ball'; expected revolute or prismatic\n"},
    {"JointTypeMisspelt",
     kBoxes + "simulation: {chains: [{name: c, joints: [{type: @revolut}]}]}\n",
     "found the text 'revolut'; expected revolute or prismatic; did you mean 'revolute'?"},
    {"ListWithoutEnd", "objects: [\n@",
     "found what is not valid YAML (end of sequence flow not found); expected ',' or ']'"},
    {"MapWithoutEnd", "dds: {domain: 1\n@",
     "found what is not valid YAML (end of map flow not found); expected ',' or '}'"},
    {"KeyTooFarLeft", "dds:\n  domain: 1\n @partition: x\n",
     "found what is not valid YAML (end of map not found); expected another key as far to the "
     "right "
     "as the one before"},
    {"TabForBlanks", "dds:\n\tdomain@: 1\n",
     "found what is not valid YAML (illegal map value); expected one 'key: value' a line, no tabs "
     "before it"},
    {"TabForBlanksInAText", "partition: |\n@\tx\n",
     "found what is not valid YAML (illegal tab when looking for indentation); expected blanks"},
    {"TwoColonsInALine", "partition: a@: b\n",
     "found what is not valid YAML (illegal map value); expected one 'key: value' a line"},
    {"UnknownAnchor", "dds: @*nowhere\n",
     "found what is not valid YAML (the referenced anchor is "},
    {"StrayByte", "dds: @%x\n",
     "found what is not valid YAML (unknown token); expected valid YAML"},
};

INSTANTIATE_TEST_SUITE_P(Each, CellMistake, testing::ValuesIn(kMistakes),
                         [](const auto& mistake) { return std::string(mistake.param.name); });

TEST(CellMistakes, UnitsAndNameAreRequired) {
  const std::string errors = errors_of("budget: 3\n");
  EXPECT_THAT(errors,
              testing::HasSubstr("cell.yaml:1:1: found no key 'name'; expected it in a cell"));
  EXPECT_THAT(errors,
              testing::HasSubstr("cell.yaml:1:1: found no key 'units'; expected it in a cell"));
  EXPECT_THAT(errors, testing::HasSubstr("cell.yaml:1:1: found no key 'objects'"));
  EXPECT_THAT(errors, testing::HasSubstr("cell.yaml:1:1: found no key 'pairs'"));
}

TEST(CellMistakes, BothLimitsOfTheRateAreNamed) {
  for (const char* rate : {".inf", "0", "10001", "-.inf", "1e999"}) {
    const std::string errors =
        errors_of("name: test\nunits: {length: m, angle: deg}\nrate_hz: " + std::string(rate) +
                  "\n" + kBoxes);
    EXPECT_THAT(errors,
                testing::StartsWith("cell.yaml:3:10: found the number " + std::string(rate)));
    EXPECT_THAT(errors, testing::EndsWith("; expected the rate in Hz, from 1 to 10000\n"));
  }
}

TEST(CellMistakes, OneMistakeGivesOneError) {
  // A name that could not be read must not make every use of it an error.
  const std::string errors = errors_of(
      cell_text("objects:\n"
                "  - {name: 12, sphere: {radius: 1}}\n"
                "  - {name: b, groups: [g], sphere: {radius: 1}}\n"
                "pairs: [{between: [twelve, g]}]\n"
                "zones: [{name: z, between: [twelve, g], enter_below: 1, leave_above: 1}]\n"));
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
}

}  // namespace
}  // namespace clearance
