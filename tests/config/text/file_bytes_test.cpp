#include "config/text/file_bytes.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

TEST(FileBytes, AreThoseOfARegularFile) {
  const test::ScratchFolder folder;
  const std::string bytes("a\0b\n", 4);
  test::write_text(folder / "file", bytes);
  EXPECT_EQ(std::get<std::string>(read_bytes((folder / "file").string())), bytes);
  std::filesystem::create_symlink(folder / "file", folder / "link");
  EXPECT_EQ(std::get<std::string>(read_bytes((folder / "link").string())), bytes);
}

// Nothing writes into the FIFO, so an opener that waits for a writer never returns.
TEST(FileBytes, OfNothingElseAreReadOrWaitedFor) {
  const test::ScratchFolder folder;
  ASSERT_EQ(::mkfifo((folder / "fifo").c_str(), 0600), 0);
  for (const std::filesystem::path& path :
       {folder / "fifo", folder / "none", std::filesystem::path(folder / "."),
        std::filesystem::path("/dev/zero")}) {
    EXPECT_TRUE(std::holds_alternative<FileFault>(read_bytes(path.string()))) << path;
    EXPECT_EQ(open_file(path), nullptr) << path;
  }
  EXPECT_EQ(open_to_read(folder / "fifo"), -1);
  EXPECT_EQ(errno, EINVAL);
}

}  // namespace
}  // namespace clearance
