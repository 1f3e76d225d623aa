// Oracle: whatever the bytes, reading a cell ends in a scene with valid indices, or in errors. Each
// error names a line of the file, what was found there and what was expected. Seeds are fixed, and
// a failure prints its seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "tests/config/cells.hpp"
#include "tests/shared/mutation.hpp"
#include "tests/shared/places.hpp"

namespace clearance {
namespace {

std::string shipped_text(const std::string& name) {
  std::ifstream stream(test::places::sources() + "/config/cells/" + name);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void expect_sound(const Scene& scene) {
  for (const ObjectPair& pair : scene.pairs) {
    ASSERT_LT(pair.first, pair.second);
    ASSERT_LT(pair.second, scene.objects.size());
  }
  for (const Zone& zone : scene.zones) {
    ASSERT_FALSE(zone.pairs.empty());
    ASSERT_LT(*std::max_element(zone.pairs.begin(), zone.pairs.end()), scene.pairs.size());
    ASSERT_GE(zone.leave_above, zone.enter_below);
  }
  for (const Object& object : scene.objects) {
    ASSERT_FALSE(object.parts.empty());
    for (const Part& part : object.parts) ASSERT_TRUE(object.fixed || part.shape.bounded());
  }
}

void expect_located(const std::vector<CellError>& errors, const std::string& text) {
  ASSERT_FALSE(errors.empty());
  const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
  for (const CellError& error : errors) {
    ASSERT_EQ(error.text.rfind("cell.yaml:", 0), 0u) << error.text;
    std::size_t used = 0;
    const int line = std::stoi(error.text.substr(10), &used);
    ASSERT_GE(line, 1) << error.text;
    ASSERT_LE(line, lines + 1) << error.text;
    ASSERT_GE(std::stoi(error.text.substr(10 + used + 1)), 1) << error.text;
    ASSERT_NE(error.text.find(": found "), std::string::npos) << error.text;
    ASSERT_NE(error.text.find("; expected "), std::string::npos) << error.text;
  }
}

TEST(CellFuzz, EveryDamagedCellIsReadOrRefusedWithAPlace) {
  const std::string whole = shipped_text("mcintyre.yaml");
  ASSERT_FALSE(whole.empty());
  int scenes = 0, refused = 0;
  for (std::uint32_t seed = 0; seed < 800; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const std::string text = test::mutated(whole, random);
    const CellResult result = parse_cell(text, "cell.yaml");
    if (const auto* cell = std::get_if<Cell>(&result)) {
      ASSERT_NO_FATAL_FAILURE(expect_sound(cell->scene));
      ++scenes;
    } else {
      ASSERT_NO_FATAL_FAILURE(expect_located(std::get<std::vector<CellError>>(result), text));
      ++refused;
    }
  }
  EXPECT_GT(scenes, 50);  // an edit of a comment or of a number leaves a valid cell
  EXPECT_GT(refused, 200);
}

TEST(CellFuzz, EveryPrefixOfACellIsRefusedWithAPlace) {
  const std::string whole = cell_text(kBoxes);
  for (std::size_t length = 0; length + 20 < whole.size(); ++length) {
    const std::string text = whole.substr(0, length);
    const CellResult result = parse_cell(text, "cell.yaml");
    const auto* errors = std::get_if<std::vector<CellError>>(&result);
    ASSERT_NE(errors, nullptr) << text;
    ASSERT_NO_FATAL_FAILURE(expect_located(*errors, text));
  }
}

}  // namespace
}  // namespace clearance
