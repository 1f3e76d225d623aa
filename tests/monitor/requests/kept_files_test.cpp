// Two things stay on the disk: the last accepted scene, and files that commands send.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "monitor/requests/kept_scene.hpp"
#include "monitor/requests/sent_files.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using test::ScratchFolder;

std::string content(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::size_t files_in(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder)) return 0;
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder),
                                                std::filesystem::directory_iterator()));
}

TEST(KeptScene, IsWhatWasKeptLast) {
  const ScratchFolder folder;
  const auto file = folder / "scene.yaml";
  EXPECT_EQ(std::get<0>(read_kept_scene(file)), std::nullopt);
  ASSERT_EQ(keep_scene(file, {0x1234, "name: a\n"}), "");
  ASSERT_EQ(keep_scene(file, {0xfedcba9876543210, "name: b\n# end\n"}), "");
  const auto kept = std::get<0>(read_kept_scene(file));
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->began_with, 0xfedcba9876543210);
  EXPECT_EQ(kept->yaml, "name: b\n# end\n");
  EXPECT_EQ(files_in(folder / "."), 1u) << "nothing else is left";
}

// A process that was killed while it wrote. No process has a number above that of the kernel's
// limit.
TEST(KeptScene, AndSentFilesLeaveNothingUnfinishedBehind) {
  const ScratchFolder folder;
  const auto file = folder / "scene.yaml";
  constexpr const char* kGone = "scene.yaml.99999999.new";
  const std::string running = "scene.yaml." + std::to_string(::getpid()) + ".new";
  for (const std::string& name : {std::string(kGone), running, std::string("other.99999999.new"),
                                  std::string("scene.yaml.new")})
    std::ofstream(folder / name) << "half";
  EXPECT_EQ(std::get<0>(read_kept_scene(file)), std::nullopt);
  EXPECT_FALSE(std::filesystem::exists(folder / kGone));
  EXPECT_TRUE(std::filesystem::exists(folder / running)) << "its process runs";
  EXPECT_EQ(files_in(folder / "."), 3u) << "other files are not ours";
  std::filesystem::create_directory(folder / "clearance.sent");
  std::ofstream(folder / "clearance.sent" / "0123.stl.99999999.new") << "half";
  std::ofstream(folder / "clearance.sent" / "0123.stl") << "whole";
  const SentFiles sent(folder / "cell.yaml");
  EXPECT_EQ(files_in(folder / "clearance.sent"), 1u);
}

TEST(KeptScene, OfAnotherProgramOrCutOffIsRefused) {
  const ScratchFolder folder;
  const auto file = folder / "scene.yaml";
  ASSERT_EQ(keep_scene(file, {7, ""}), "");
  const std::string head = content(file);
  for (const std::string& text :
       {std::string(), std::string("name: cell\n"), head.substr(0, head.size() - 1),
        head.substr(0, head.size() - 5), "x" + head}) {
    std::ofstream(file) << text;
    EXPECT_TRUE(std::holds_alternative<std::string>(read_kept_scene(file))) << text;
  }
}

TEST(KeptScene, ThatCannotBeWrittenSaysWhyAndLeavesTheFormerOne) {
  const ScratchFolder folder;
  EXPECT_NE(keep_scene(folder / "none" / "scene.yaml", {7, "x"}), "");
  std::filesystem::create_directory(folder / "taken");
  EXPECT_NE(keep_scene(folder / "taken", {7, "x"}), "");
  EXPECT_EQ(files_in(folder / "."), 1u) << "no half of a file is left";
}

TEST(SentFiles, AreKeptByTheirContentBesideTheCell) {
  const ScratchFolder folder;
  SentFiles files(folder / "cell.yaml");
  const auto first = std::get<0>(files.keep({{"a.stl", "one"}, {"b.obj", "two"}}));
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(content(folder / first.at("a.stl")), "one");
  EXPECT_EQ(content(folder / first.at("b.obj")), "two");
  EXPECT_TRUE(first.at("a.stl").ends_with(".stl"));
  const auto again = std::get<0>(files.keep({{"other.stl", "one"}}));
  EXPECT_EQ(again.at("other.stl"), first.at("a.stl"));
  EXPECT_EQ(files_in(files.folder()), 2u);
}

TEST(SentFiles, OfARefusedCommandGoAndFormerOnesStay) {
  const ScratchFolder folder;
  SentFiles files(folder / "cell.yaml");
  (void)files.keep({{"a.stl", "one"}});
  (void)files.keep({{"a.stl", "one"}, {"c.stl", "three"}});
  EXPECT_EQ(files_in(files.folder()), 2u);
  files.take_back();
  EXPECT_EQ(files_in(files.folder()), 1u);
}

TEST(SentFiles, WhoseContentIsNotWhatTheNameSaysAreRefused) {
  const ScratchFolder folder;
  SentFiles files(folder / "cell.yaml");
  const auto path = folder / std::get<0>(files.keep({{"a.stl", "one"}})).at("a.stl");
  std::ofstream(path) << "changed";
  EXPECT_TRUE(std::holds_alternative<std::string>(files.keep({{"a.stl", "one"}})));
}

TEST(SentFiles, StandForTheirNamesInATextAndForNoOthers) {
  const std::map<std::string, std::string> paths = {{"a.stl", "P"}, {"a", "Q"}};
  EXPECT_EQ(with_paths("mesh: {file: \"sent:a.stl\"}", paths), "mesh: {file: \"P\"}");
  EXPECT_EQ(with_paths("sent:a sent:a.stl, sent:a.st", paths), "Q P, sent:a.st");
  EXPECT_EQ(with_paths("present:a", paths), "present:a");
  EXPECT_EQ(with_paths("sent:", paths), "sent:");
  EXPECT_EQ(with_paths("", paths), "");
}

}  // namespace
}  // namespace clearance
