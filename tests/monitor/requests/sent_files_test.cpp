// The files of commands that another daemon does: they wait for the cell that names them.
#include "monitor/requests/sent_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

class SentFilesOfAnotherDaemon : public testing::Test {
 protected:
  // Returns the path of the file with this content.
  std::filesystem::path keep(const std::string& content) {
    const std::vector<SentFile> sent{{"mesh.obj", content}};
    EXPECT_EQ(files.keep_awaited(sent), "");
    return folder / std::get<0>(SentFiles(folder / "cell.yaml").keep(sent)).at("mesh.obj");
  }
  static std::string content(int i) { return "# " + std::to_string(i); }

  test::ScratchFolder folder;
  SentFiles files{folder / "cell.yaml"};
};

TEST_F(SentFilesOfAnotherDaemon, WaitForACellThatNamesThemAndTheOldestGo) {
  const auto named = keep("named"), unnamed = keep("unnamed"), again = keep("again");
  files.settle({named});
  for (int i = 0; i < static_cast<int>(SentFiles::kAwaited) - 1; ++i) {
    keep(content(i));
    if (i == 3) {
      EXPECT_EQ(keep("again"), again);
    }
  }
  EXPECT_TRUE(exists(named));
  EXPECT_FALSE(exists(unnamed)) << "no cell has named it";
  EXPECT_TRUE(exists(again)) << "it was sent again";
  for (int i = 0; i < 6; ++i) keep(content(1000 + i));
  EXPECT_FALSE(exists(again));
  // The cells of later commands do not name the first one any more.
  for (std::size_t i = 0; i < SentFiles::kScenes; ++i) files.settle({});
  EXPECT_FALSE(exists(named));
}

TEST_F(SentFilesOfAnotherDaemon, TakeNoMoreBytesThanTheDaemonThatDoesTheCommands) {
  const std::string large(SentFiles::kAwaitedBytes / 2, 'x');
  const auto first = keep(large + "1"), second = keep(large + "2");
  EXPECT_FALSE(exists(first));
  EXPECT_TRUE(exists(second));
}

TEST_F(SentFilesOfAnotherDaemon, ThatWereThereBeforeStay) {
  const std::vector<SentFile> sent{{"mesh.obj", "mine"}};
  const auto path = folder / std::get<0>(SentFiles(folder / "cell.yaml").keep(sent))["mesh.obj"];
  EXPECT_EQ(files.keep_awaited(sent), "");
  for (int i = 0; i < 2 * static_cast<int>(SentFiles::kAwaited); ++i) keep(content(i));
  EXPECT_TRUE(exists(path));
}

TEST_F(SentFilesOfAnotherDaemon, AreNamedIfTheyCannotBeKept) {
  test::write_text(folder / "clearance.sent", "no folder");
  EXPECT_NE(files.keep_awaited({{"mesh.obj", "x"}}).find("clearance.sent"), std::string::npos);
}

}  // namespace
}  // namespace clearance
