// The hash of a cell covers its text and each file that it names. The oracle is which file was
// changed.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <variant>

#include "config/cell/cell_file.hpp"
#include "config/text/sha256.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

constexpr const char* kHashedCell = R"(name: hashed
units: {length: m, angle: rad}
rate_hz: 1000
robots:
  - {name: arm, urdf: arm.urdf, srdf: arm.srdf}
objects:
  - {name: block, fixed: true, mesh: {file: block.obj}}
pairs:
  - {between: [arm, block], publish: true}
)";
constexpr const char* kHashedUrdf = R"(<robot name="arm">
  <link name="base"/>
  <link name="tip"><collision><geometry><sphere radius="0.25"/></geometry></collision></link>
  <joint name="j" type="continuous"><parent link="base"/><child link="tip"/><origin xyz="0 0 5"/></joint>
</robot>
)";
constexpr const char* kHashedSrdf = "<robot name=\"arm\"/>\n";
constexpr const char* kHashedMesh =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

class CellHash : public testing::Test {
 protected:
  CellHash() {
    test::write_text(folder / "cell.yaml", kHashedCell);
    test::write_text(folder / "arm.urdf", kHashedUrdf);
    test::write_text(folder / "arm.srdf", kHashedSrdf);
    test::write_text(folder / "block.obj", kHashedMesh);
  }
  CellResult read() { return read_cell(folder / "cell.yaml"); }
  test::ScratchFolder folder;
};

TEST_F(CellHash, IsTheSameForTheSameFilesAndNamesTheHashOfEach) {
  const Cell one = std::get<Cell>(read()), same = std::get<Cell>(read());
  EXPECT_EQ(one.hash, same.hash);
  EXPECT_EQ(one.hash.size(), 64u);
  ASSERT_EQ(one.files.size(), 3u);
  ASSERT_EQ(one.file_hashes.size(), 3u);
  for (std::size_t i = 0; i < one.files.size(); ++i)
    EXPECT_EQ(one.file_hashes[i], sha256(test::read_text(one.files[i]))) << one.files[i];
}

// Tries every seventh byte, since a mesh is read in a process of its own. A byte that makes no cell
// of the text is refused. Each other one gives another hash.
TEST_F(CellHash, ChangesWithTheBytesOfEachFile) {
  std::set<std::string> hashes{std::get<Cell>(read()).hash};
  for (const char* const name : {"cell.yaml", "arm.urdf", "arm.srdf", "block.obj"}) {
    const std::string text = test::read_text(folder / name);
    int read_again = 0;
    for (std::size_t byte = 0; byte < text.size(); byte += 7) {
      std::string changed = text;
      changed[byte] = static_cast<char>(changed[byte] ^ 1);
      test::write_text(folder / name, changed);
      const CellResult result = read();
      const auto* cell = std::get_if<Cell>(&result);
      if (cell == nullptr) continue;
      ++read_again;
      EXPECT_TRUE(hashes.insert(cell->hash).second) << name << ", byte " << byte;
    }
    EXPECT_GT(read_again, 0) << name;
    test::write_text(folder / name, text);
  }
}

}  // namespace
}  // namespace clearance
