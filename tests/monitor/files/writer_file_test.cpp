// The MCAP writer's behaviour if its file cannot be created, is full, or is changed by another
// program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <functional>

#include "monitor/files/writer.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;

TEST(McapWriterFile, KeepsAnExistingFileWhenTold) {
  const ScratchFolder folder;
  write_text(folder / "a.mcap", "precious");
  McapWriter writer(folder / "a.mcap", {.overwrite = false});
  EXPECT_THAT(writer.error(), HasSubstr("cannot create " + (folder / "a.mcap").string()));
  EXPECT_FALSE(writer.close());
  EXPECT_EQ("precious", read_text(folder / "a.mcap"));
}

// A limit on the size of files simulates a full disk.
TEST(McapWriterFile, SaysThatNothingMoreCanBeWritten) {
  const ScratchFolder folder;
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto heeded = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{100, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  McapWriter writer(folder / "a.mcap");
  const std::uint16_t channel = writer.add_channel({"A", "omgidl", ""}, "a", "cdr");
  writer.write(channel, 1, 1, std::vector(100, std::byte{'x'}));
  EXPECT_FALSE(writer.close());
  EXPECT_THAT(writer.error(), HasSubstr("cannot write to " + (folder / "a.mcap").string() + ": "));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, heeded);
}

TEST(McapWriterFile, RefusesWhatIsNoRegularFileWithoutWaitingForAReader) {
  const ScratchFolder folder;
  ASSERT_EQ(0, mkfifo((folder / "pipe").c_str(), 0600));
  for (const std::filesystem::path& file : {folder / "pipe", std::filesystem::path("/dev/null")}) {
    McapWriter writer(file);
    EXPECT_THAT(writer.error(), HasSubstr("it is no regular file; expected one"));
    EXPECT_FALSE(writer.close());
  }
}

TEST(McapWriterFile, NoticesWhatOthersDoToItsFile) {
  const ScratchFolder folder;
  const auto file = folder / "a.mcap";
  const auto error_after = [&file](const std::function<void()>& deed) {
    McapWriter writer(file);
    EXPECT_TRUE(writer.check()) << writer.error();
    deed();
    EXPECT_FALSE(writer.check());
    EXPECT_FALSE(writer.close());
    return writer.error();
  };
  EXPECT_THAT(error_after([&] { std::filesystem::remove(file); }), HasSubstr("was deleted"));
  EXPECT_THAT(error_after([&] { std::filesystem::resize_file(file, 1); }),
              HasSubstr("was changed by another program"));
  EXPECT_THAT(error_after([&] { std::filesystem::rename(file, folder / "b.mcap"); }),
              HasSubstr("was moved or replaced"));
}

}  // namespace
}  // namespace clearance::test
