// A recording keeps the files that its cell was read from, and can be read when none of them exists
// any more.
#include "monitor/recording/recorded_cell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include "monitor/files/attachments.hpp"
#include "monitor/files/writer.hpp"
#include "monitor/recording/recorder.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;

const char* const kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n";

// A cell with every kind of file: one mesh in its directory and one above it, a planning scene, and
// a robot. An absolute path names the robot's URDF, and its mesh is in a package.
class RecordedCell : public testing::Test {
 protected:
  RecordedCell() {
    write("made/cells/near.obj", kTetrahedron);
    write("made/meshes/above.obj", kTetrahedron);
    write("made/ws/arm_description/link.obj", kTetrahedron);
    write("made/ws/arm_description/urdf/arm.urdf",
          "<robot name=\"arm\">\n<link name=\"foot\"><collision><geometry><box size=\"1 1 1\"/>"
          "</geometry></collision></link>\n<link name=\"hand\"><collision><geometry><mesh "
          "filename=\"package://arm_description/link.obj\"/></geometry></collision></link>\n"
          "<link name=\"tool\"><collision><geometry><sphere radius=\"0.1\"/></geometry></collision>"
          "</link>\n"
          "<joint name=\"j\" type=\"continuous\"><parent link=\"foot\"/><child link=\"hand\"/>"
          "</joint>\n<joint name=\"k\" type=\"continuous\"><parent link=\"hand\"/><child "
          "link=\"tool\"/></joint>\n</robot>\n");
    write("made/cells/arm.srdf",
          "<robot name=\"arm\"><disable_collisions link1=\"foot\" link2=\"hand\"/></robot>\n");
    write("made/cells/shelf.scene", "shelf\n* board\n1\nbox\n1 1 1\n5 0 0\n0 0 0 1\n0 0 0 0\n.\n");
    write("made/cells/cell.yaml",
          "name: kept\nunits: {length: m, angle: rad}\n"
          "scenes: [{file: shelf.scene, group: shelf}]\n"
          "robots: [{name: arm, srdf: arm.srdf, urdf: " +
              (folder / "made/ws/arm_description/urdf/arm.urdf").string() +
              "}]\n"
              "objects:\n  - {name: a, mesh: {file: near.obj}}\n"
              "  - {name: b, mesh: {file: ../meshes/above.obj}}\n"
              "pairs: [{between: [a, b]}, {between: [arm, arm]}, {between: [arm, shelf]}, "
              "{between: [a, shelf]}]\n");
    const CellResult read = read_cell(folder / "made/cells/cell.yaml");
    if (const auto* errors = std::get_if<std::vector<CellError>>(&read)) {
      for (const CellError& error : *errors) ADD_FAILURE() << error.text;
      return;
    }
    cell = std::get<Cell>(read);
  }

  void write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name) << text;
  }

  // The cell of a recording with these options, read where its files no longer exist.
  CellResult recorded(const RecordingOptions& options) {
    Recorder recorder(run, cell, 1000, options);
    without_files = recorder.without_files();
    EXPECT_TRUE(recorder.close()) << recorder.error();
    std::filesystem::remove_all(folder / "made");
    const auto read = recorded_cell(run, outline(run));
    EXPECT_TRUE(read);
    return read.value_or(std::vector<CellError>{});
  }
  // The errors of a recording of `cell` that the recorder did not make. It states where the cell's
  // file was, and has one attachment.
  std::string errors_of_recording(const std::string& cell_file, const std::string& attachment,
                                  std::string_view bytes) {
    McapWriter writer(run);
    writer.attachment(attachment, "text/plain", std::as_bytes(std::span(bytes)));
    writer.metadata(kRecordingMetadata, {{"cell_file", cell_file}});
    const auto channel = writer.add_channel(topic_schema(TopicKind::kCatalogue),
                                            "clearance/catalogue", kCdrEncoding);
    CdrEncoder encoder;
    writer.write(channel, 1, 1, encoder.encode(*make_catalogue(cell)));
    EXPECT_TRUE(writer.close());
    const auto read = recorded_cell(run, outline(run));
    EXPECT_TRUE(read);
    return errors_in(read.value_or(std::vector<CellError>{}));
  }
  static std::string errors_in(const CellResult& result) {
    std::string text;
    if (const auto* errors = std::get_if<std::vector<CellError>>(&result)) {
      for (const CellError& error : *errors) text += error.text + "\n";
    }
    return text;
  }

  ScratchFolder folder;
  std::filesystem::path run = folder / "run.mcap";
  Cell cell;
  std::string without_files;
};

TEST_F(RecordedCell, NeedsNoneOfItsFiles) {
  EXPECT_EQ(6u, cell.files.size());
  const CellResult result = recorded({});
  EXPECT_EQ("", without_files);
  ASSERT_EQ("", errors_in(result));
  const Scene& scene = cell.scene;
  const Scene& again = std::get<Cell>(result).scene;
  EXPECT_EQ(scene.revision, again.revision);
  EXPECT_EQ(scene.objects.size(), again.objects.size());
  EXPECT_EQ(scene.pairs.size(), again.pairs.size());
  EXPECT_FALSE(std::filesystem::exists(std::get<Cell>(result).file)) << "left behind";
}

TEST_F(RecordedCell, NeedsNoneOfItsFilesUncompressedEither) {
  const CellResult result = recorded({.compress = false});
  ASSERT_EQ("", errors_in(result));
  EXPECT_EQ(cell.scene.revision, std::get<Cell>(result).scene.revision);
  EXPECT_EQ(6u, read_attachments(run).found.size());
}

TEST_F(RecordedCell, SaysThatFilesAreMissingWhereTheyWereTooLarge) {
  EXPECT_THAT(errors_in(recorded({.attach_bytes = 100})),
              HasSubstr("found a file that cannot be used"));
  EXPECT_EQ("they are more than 0.0 MB", without_files);
}

TEST_F(RecordedCell, HasNoneWhereNoneWereAskedFor) {
  EXPECT_NE("", errors_in(recorded({.attach_bytes = 0})));
  EXPECT_EQ("", without_files);
  EXPECT_TRUE(read_attachments(run).found.empty());
}

TEST_F(RecordedCell, IsInEveryFileOfSeveral) {
  {
    RecordingWriter writer(run, Topics{}, {.roll_ns = 10});
    ASSERT_EQ("", writer.attach(cell));
    writer.catalogue(*make_catalogue(cell), 0);
    for (std::int64_t t = 1; t < 30; ++t) {
      writer.write(TopicKind::kPoses, t, t, *make_batch(0));
      static_cast<void>(writer.roll(t));
    }
    ASSERT_GT(writer.part(), 2u);
  }
  std::filesystem::remove_all(folder / "made");
  for (const char* part : {"run.mcap", "run-2.mcap"}) {
    const auto read = recorded_cell(folder / part, outline(folder / part));
    ASSERT_TRUE(read) << part;
    EXPECT_EQ("", errors_in(*read)) << part;
  }
}

// A recording is not trusted: its files are written into a private directory or not at all.
TEST_F(RecordedCell, IsRefusedWhereAFileWouldStandElsewhere) {
  for (const std::string name : {"/../../escaped", "escaped", "/tmp/../../escaped", "/"}) {
    EXPECT_THAT(errors_of_recording("/cells/cell.yaml", name, "x"),
                HasSubstr("'" + name + "' leads out"));
    EXPECT_THAT(errors_of_recording(name, "/cells/x", "x"), HasSubstr("'" + name + "' leads out"));
  }
}

// The cell's own text is not trusted either. The files that it names exist, so that only the rule
// refuses them.
TEST_F(RecordedCell, IsRefusedWhereItNamesAFileElsewhere) {
  write("kept_out.obj", kTetrahedron);
  write("kept_out.scene", "shelf\n* board\n1\nbox\n1 1 1\n5 0 0\n0 0 0 1\n0 0 0 0\n.\n");
  write("kept_out.urdf", "<robot name=\"arm\"/>\n");
  const std::string elsewhere = "../../../../../../../.." + (folder / "kept_out").string();
  const std::string balls =
      "objects: [{name: a, sphere: {radius: 1}}, {name: b, sphere: {radius: 1}}]\n";
  for (const std::string& objects :
       {"objects: [{name: a, mesh: {file: " + elsewhere +
            ".obj}}, {name: b, sphere: {radius: 1}}]\n",
        "objects: [{name: a, mesh: {file: /" + elsewhere +
            ".obj}}, {name: b, sphere: {radius: 1}}]\n",
        balls + "scenes: [{group: shelf, file: " + elsewhere + ".scene}]\n",
        balls + "robots: [{name: arm, urdf: " + elsewhere + ".urdf}]\n"}) {
    cell.yaml =
        "name: kept\nunits: {length: m, angle: rad}\n" + objects + "pairs: [{between: [a, b]}]\n";
    EXPECT_THAT(errors_of_recording("/cells/cell.yaml", "/cells/x", "x"),
                HasSubstr("leads out of the files that are kept with the cell"))
        << objects;
  }
}

TEST_F(RecordedCell, IsRefusedWhereItsRobotNamesAMeshElsewhere) {
  write("kept_out.obj", kTetrahedron);
  const std::string urdf =
      "<robot name=\"arm\"><link name=\"foot\"><collision><geometry><mesh filename=\""
      "../../../../../../../.." +
      (folder / "kept_out.obj").string() + "\"/></geometry></collision></link></robot>\n";
  cell.yaml =
      "name: kept\nunits: {length: m, angle: rad}\nrobots: [{name: arm, urdf: arm.urdf}]\n"
      "objects: [{name: a, sphere: {radius: 1}}]\npairs: [{between: [a, arm]}]\n";
  EXPECT_THAT(errors_of_recording("/cells/cell.yaml", "/cells/arm.urdf", urdf),
              HasSubstr("leads out of the files that are kept with the cell"));
}

TEST_F(RecordedCell, OfADamagedAttachmentIsRefused) {
  {
    Recorder recorder(run, cell, 1000, {.compress = false});
    ASSERT_TRUE(recorder.close());
  }
  std::string bytes;
  {
    std::ifstream in(run, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
  }
  const std::size_t at = bytes.find("v 0 0 0");
  ASSERT_NE(at, std::string::npos);
  bytes[at + 2] = '7';
  std::ofstream(run, std::ios::binary) << bytes;
  const auto read = recorded_cell(run, outline(run));
  ASSERT_TRUE(read);
  EXPECT_THAT(errors_in(*read), HasSubstr("is damaged or too large"));
}

}  // namespace
}  // namespace clearance::test
