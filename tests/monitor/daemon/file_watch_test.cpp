#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>

#include "monitor/daemon/file_watch.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

class FileWatchTest : public testing::Test {
 protected:
  // Clocks of file systems may be coarse, so each text gets a later time.
  void write(const std::string& name, const std::string& text) {
    test::write_text(folder / name, text);
    std::filesystem::last_write_time(folder / name, time += std::chrono::seconds(1));
  }

  const test::ScratchFolder folder;
  std::filesystem::file_time_type time = std::filesystem::file_time_type::clock::now();
  FileWatch watch;
};

TEST_F(FileWatchTest, TellsOfAChangeOnceTheFileHasSettled) {
  write("a", "1");
  watch.watch({folder / "a"});
  EXPECT_FALSE(watch.changed());
  write("a", "2");
  EXPECT_FALSE(watch.changed()) << "a program may still write it";
  write("a", "3");
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
  EXPECT_FALSE(watch.changed()) << "once";
}

TEST_F(FileWatchTest, TellsOfAFileThatGoesOrComes) {
  write("a", "1");
  watch.watch({folder / "a", folder / "b"});
  write("b", "1");
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
  std::filesystem::remove(folder / "a");
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
}

TEST_F(FileWatchTest, ForgetsOtherFilesAndMissesNoChangeOfThoseThatStay) {
  write("a", "1");
  write("b", "1");
  watch.watch({folder / "a", folder / "b"});
  write("a", "2");
  write("b", "2");
  watch.watch({folder / "a"});
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
  write("b", "3");
  EXPECT_FALSE(watch.changed());
  EXPECT_FALSE(watch.changed());
}

}  // namespace
}  // namespace clearance
