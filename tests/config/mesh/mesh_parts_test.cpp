#include "config/mesh/mesh_parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include <sys/stat.h>
#include <unistd.h>

#include "config/mesh/file_lock.hpp"
#include "config/write/single_robot_cell.hpp"
#include "tests/config/cells.hpp"
#include "tests/shared/mistake_at.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tools/cases/drawn_meshes.hpp"

namespace clearance {
namespace {

using test::mistake_at;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// A cell with an L of sheet bars, and the lines that its reader logged.
class PartsOfMeshes : public testing::Test {
 protected:
  PartsOfMeshes() {
    test::write_text(folder_ / "l.obj", drawn::obj_of(drawn::l_shape()));
    ::setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
  }
  ~PartsOfMeshes() override { ::unsetenv("XDG_CACHE_HOME"); }

  Scene read(const std::string& keys = "", const std::string& sections = "") {
    return read_text(sections + "objects:\n  - {name: a, mesh: {file: l.obj" + keys +
                     "}}\n  - {name: b, sphere: {radius: 1}}\npairs: [{between: [a, b]}]\n");
  }

  Scene read_text(const std::string& sections, const std::string& file = "cell.yaml") {
    const std::string text = cell_text(sections);
    told_.clear();
    errors_.clear();
    CellOptions options;
    options.tell = [this](const std::string& line) {
      told_ += line + "\n";
      if (told_to_) told_to_(line);
    };
    options.mesh_errors = &mesh_errors_;
    CellResult result = parse_cell(text, folder_ / file, options);
    if (auto* cell = std::get_if<Cell>(&result)) return std::move(cell->scene);
    for (const CellError& error : std::get<std::vector<CellError>>(result)) errors_ += error.text;
    return {};
  }

  // True if the mesh was split into its two parts, rather than found in a folder of parts.
  [[nodiscard]] bool was_split() const { return told_.find("l.obj: 2 parts") != std::string::npos; }

  // The only file in a folder.
  static std::filesystem::path only_file(const std::filesystem::path& folder) {
    EXPECT_EQ(1, std::distance(std::filesystem::directory_iterator(folder), {}));
    return std::filesystem::directory_iterator(folder)->path();
  }

  static std::vector<Vec3> anchors(const Scene& scene) {
    std::vector<Vec3> all;
    for (const Part& part : scene.objects.at(0).parts) {
      all.insert(all.end(), part.shape.anchors.begin(), part.shape.anchors.end());
    }
    return all;
  }

  test::ScratchFolder folder_;
  std::string told_, errors_;
  std::function<void(const std::string&)> told_to_;
  std::map<std::string, double> mesh_errors_;
};

TEST_F(PartsOfMeshes, AreMadeOnceAndKeptBesideTheCell) {
  const Scene first = read();
  EXPECT_TRUE(was_split());
  only_file(folder_ / "clearance.parts");
  const Scene second = read();
  EXPECT_THAT(told_, IsEmpty());
  EXPECT_EQ(anchors(first), anchors(second));
  EXPECT_EQ(first.revision, second.revision);
  EXPECT_EQ(second.objects.at(0).parts.at(1).name, "mesh.1");
  EXPECT_GT(mesh_errors_.at("a"), 0.0);
  EXPECT_LE(mesh_errors_.at("a"), 5e-3);
  EXPECT_FALSE(mesh_errors_.contains("b"));
}

const std::string kOneMesh =
    "objects:\n  - {name: a, mesh: {file: l.obj}}\n  - {name: b, sphere: {radius: 1}}\n"
    "pairs: [{between: [a, b]}]\n";

TEST_F(PartsOfMeshes, AreFoundByEveryCellOfTheFolderWhateverTheMeshIsCalled) {
  const Scene first = read_text(kOneMesh, "first.yaml");
  EXPECT_TRUE(was_split());
  const Scene second = read_text(kOneMesh, "second.yaml");
  EXPECT_THAT(told_, IsEmpty());
  EXPECT_EQ(anchors(first), anchors(second));
  EXPECT_EQ(first.revision, second.revision);
  std::filesystem::rename(folder_ / "l.obj", folder_ / "renamed.obj");
  std::string renamed = kOneMesh;
  renamed.replace(renamed.find("l.obj"), 5, "renamed.obj");
  EXPECT_EQ(anchors(first), anchors(read_text(renamed)));
  EXPECT_THAT(told_, IsEmpty());
  only_file(folder_ / "clearance.parts");
}

TEST_F(PartsOfMeshes, AreMadeAfterTheMistakesOfTheCellAreTold) {
  const std::string zone = "zones: [{name: z, between: [a, c], enter_below: 1}]\n";
  read_text(kOneMesh + zone);
  EXPECT_THAT(errors_, mistake_at("cell.yaml:8:32", "'c'"));
  EXPECT_THAT(told_, IsEmpty());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "clearance.parts"));
  read_text("rate_herz: 5\n" + kOneMesh);
  EXPECT_THAT(errors_, mistake_at("cell.yaml:4:1", "'rate_herz'"));
  EXPECT_THAT(told_, IsEmpty());
}

TEST_F(PartsOfMeshes, CountInTheBudgetOfTheCell) {
  read_text("budget: 1\nrefresh_s: 0.002\n" + kOneMesh);
  EXPECT_THAT(errors_, mistake_at("cell.yaml:4:9", "1", "2"));
}

TEST_F(PartsOfMeshes, OfAnotherUnitAreOthers) {
  read(", unit: m");
  for (const Vec3& anchor : anchors(read(", unit: mm"))) EXPECT_LT(anchor.norm(), 0.01);
  EXPECT_THAT(told_, Not(HasSubstr("[parts-again]"))) << "those in metres were taken";
}

TEST_F(PartsOfMeshes, UnderAnotherNameAreNotThoseOfThatName) {
  read();
  const auto file = only_file(folder_ / "clearance.parts");
  std::string other = file.stem();
  other.back() = other.back() == '0' ? '1' : '0';
  std::filesystem::copy(file, folder_ / "clearance.parts" / (other + file.extension().string()));
  const PartsCache cache(folder_ / "");
  EXPECT_TRUE(cache.find(file.stem()));
  EXPECT_FALSE(cache.find(other));
}

TEST_F(PartsOfMeshes, AreMadeAnewWhereTheFileIsDamaged) {
  const Scene first = read();
  const auto file = only_file(folder_ / "clearance.parts");
  const std::string good = test::read_text(file);
  std::string other_number = good;
  other_number.replace(other_number.find("0x1."), 4, "0x0.");
  for (const std::string& bad :
       {good.substr(0, good.size() / 2), other_number, std::string(), std::string("\0\xff", 2)}) {
    test::write_text(file, bad);
    EXPECT_EQ(anchors(first), anchors(read()));
    EXPECT_TRUE(was_split());
    EXPECT_EQ(good, test::read_text(file));
  }
}

// Another program wrote the file, with a correct checksum.
TEST_F(PartsOfMeshes, AreMadeAnewWhereThoseThatAreKeptDoNotContainTheMesh) {
  const Scene first = read();
  const auto file = only_file(folder_ / "clearance.parts");
  const std::string good = test::read_text(file);
  const PartsCache cache(folder_ / "");
  ConvexParts smaller = cache.find(file.stem()).value();
  for (auto& part : smaller.parts) {
    for (Vec3& vertex : part) vertex *= 0.1;
  }
  cache.keep(file.stem(), smaller);
  EXPECT_NE(good, test::read_text(file));
  EXPECT_EQ(anchors(first), anchors(read()));
  EXPECT_THAT(told_, HasSubstr("[parts-again]"));
  EXPECT_EQ(good, test::read_text(file));
}

// The checksum is correct, but no error can be so.
TEST_F(PartsOfMeshes, AreMadeAnewWhereTheErrorThatIsKeptIsNoLength) {
  read();
  const auto file = only_file(folder_ / "clearance.parts");
  const std::string good = test::read_text(file);
  const PartsCache cache(folder_ / "");
  const ConvexParts parts = cache.find(file.stem()).value();
  for (const double error : {std::nan(""), -1e-3, -kInfinity, kInfinity}) {
    ConvexParts wrong = parts;
    wrong.error = error;
    cache.keep(file.stem(), wrong);
    EXPECT_FALSE(cache.find(file.stem())) << error;
    read();
    EXPECT_THAT(told_, HasSubstr("l.obj: 2 parts")) << error;
    EXPECT_EQ(good, test::read_text(file));
  }
}

TEST_F(PartsOfMeshes, AreNotReadFromAPipeADeviceOrALink) {
  const Scene first = read();
  const auto file = only_file(folder_ / "clearance.parts");
  const std::string good = test::read_text(file);
  const auto is_made_anew = [&] {
    EXPECT_EQ(anchors(first), anchors(read()));
    EXPECT_TRUE(was_split());
    EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::symlink_status(file)));
    EXPECT_EQ(good, test::read_text(file));
    std::filesystem::remove(file);
  };
  std::filesystem::remove(file);
  ASSERT_EQ(0, ::mkfifo(file.c_str(), 0600));
  is_made_anew();
  std::filesystem::create_symlink("/dev/zero", file);
  is_made_anew();
  test::write_text(folder_ / "elsewhere", good);
  std::filesystem::create_symlink(folder_ / "elsewhere", file);
  is_made_anew();
}

TEST_F(PartsOfMeshes, AreNotTakenFromAnotherUser) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can give a file to another user";
  const Scene first = read();
  const auto folder = folder_ / "clearance.parts";
  const auto file = only_file(folder);
  constexpr uid_t kStranger = 65534;
  ASSERT_EQ(0, ::chown(file.c_str(), kStranger, static_cast<gid_t>(-1)));
  read();
  EXPECT_TRUE(was_split());
  read();
  EXPECT_THAT(told_, IsEmpty()) << "it was not written anew";
  ASSERT_EQ(0, ::chown(folder.c_str(), kStranger, static_cast<gid_t>(-1)));
  EXPECT_EQ(anchors(first), anchors(read()));
  EXPECT_THAT(told_, HasSubstr("kept in '" + (folder_ / "cache").string()));
}

TEST_F(PartsOfMeshes, OfAnotherMeshScaleOrToleranceAreOthers) {
  const Scene first = read();
  EXPECT_NEAR(read(", scale: 2").objects.at(0).parts.at(0).shape.bounding_radius,
              2.0 * first.objects.at(0).parts.at(0).shape.bounding_radius, 2e-3);
  EXPECT_TRUE(was_split());
  read(", unit: mm");
  EXPECT_THAT(told_, IsEmpty());  // its hull is within the tolerance
  EXPECT_EQ(read(", tolerance: 0.2").objects.at(0).parts.size(), 1u);
  EXPECT_EQ(read("", "defaults: {max_parts: 1}\n").objects.at(0).parts.size(), 1u);
  EXPECT_THAT(told_, HasSubstr("[mesh-far-from-parts]"));
  test::write_text(folder_ / "l.obj", drawn::obj_of(drawn::degenerate_l()));
  read();
  EXPECT_TRUE(was_split());
}

// Each scale has parts of its own, whatever was kept before: along one axis, or mirrored. The parts
// of a larger mesh would hold a smaller one, too.
TEST_F(PartsOfMeshes, OfAScaleAlongOneAxisAreOthers) {
  const auto extent = [](const Scene& scene) {
    Eigen::AlignedBox3d box;
    for (const Vec3& anchor : anchors(scene)) box.extend(anchor);
    return box;
  };
  const Eigen::AlignedBox3d plain = extent(read());
  for (const Vec3& scale :
       {Vec3(0.5, 1, 1), Vec3(1, 0.5, 1), Vec3(1, 1, 0.5), Vec3(2, 1, 1), Vec3(1, 2, 1),
        Vec3(1, 1, 2), Vec3(-1, 1, 1), Vec3(1, -1, 1), Vec3(1, 1, -1)}) {
    std::ostringstream keys;
    keys << ", scale: [" << scale.x() << ", " << scale.y() << ", " << scale.z() << "]";
    const Eigen::AlignedBox3d scaled = extent(read(keys.str()));
    EXPECT_TRUE(was_split()) << keys.str();
    const Vec3 a = plain.min().cwiseProduct(scale), b = plain.max().cwiseProduct(scale);
    EXPECT_LT((scaled.min() - a.cwiseMin(b)).norm(), 3e-2) << keys.str();
    EXPECT_LT((scaled.max() - a.cwiseMax(b)).norm(), 3e-2) << keys.str();
  }
}

TEST_F(PartsOfMeshes, GoToTheUsersCacheWhereTheFolderOfTheCellCannotBeWritten) {
  test::write_text(folder_ / "clearance.parts", "a file where a folder should be");
  read();
  EXPECT_THAT(told_, HasSubstr("kept in '" + (folder_ / "cache").string()));
  only_file(folder_ / "cache/clearance/parts");
  read();
  EXPECT_THAT(told_, IsEmpty());
}

// clearanced and clearance-robot are started at the same time on a new cell.
TEST_F(PartsOfMeshes, AreMadeByOneProgramAtATime) {
  const Scene first = read();
  const auto made = only_file(folder_ / "clearance.parts");
  const std::string text = test::read_text(made);
  std::filesystem::remove(made);
  std::promise<void> waits;
  auto other = std::make_unique<FileLock>(folder_ / "l.obj", [] {});
  std::thread program([&] {
    told_to_ = [&](const std::string& line) {
      if (line == "l.obj: another program splits it ...") waits.set_value();
    };
    EXPECT_EQ(anchors(first), anchors(read()));
  });
  waits.get_future().wait();
  test::write_text(made, text);
  other.reset();
  program.join();
  EXPECT_THAT(told_, Not(HasSubstr("parts, ")));
}

TEST_F(PartsOfMeshes, AreUsedEvenWhereNothingCanBeKept) {
  test::write_text(folder_ / "clearance.parts", "a file where a folder should be");
  test::write_text(folder_ / "cache", "another");
  EXPECT_EQ(read().objects.at(0).parts.size(), 2u);
  EXPECT_THAT(told_, HasSubstr("warning: '"));
  EXPECT_THAT(told_, HasSubstr("[parts-not-kept]"));
}

TEST_F(PartsOfMeshes, AllHaveTheRadiusAroundTheMesh) {
  const Scene scene = read(", rounding: 0.01");
  for (const Part& part : scene.objects.at(0).parts) {
    EXPECT_EQ(part.shape.radius, 0.01);
  }
}

TEST_F(PartsOfMeshes, OfARobotsLinksAreAsItsKeysSay) {
  test::write_text(folder_ / "r.urdf",
                   "<robot name='r'><link name='base'><collision><geometry><mesh "
                   "filename='l.obj'/></geometry></collision></link><link name='tip'><collision>"
                   "<geometry><sphere radius='0.1'/></geometry></collision></link><joint name='j' "
                   "type='prismatic'><origin xyz='1 0 0'/><axis xyz='1 0 0'/><limit lower='0' "
                   "upper='1' velocity='1'/><parent link='base'/><child link='tip'/></joint>"
                   "</robot>");
  const auto parts = [this](const std::string& keys) {
    const Scene scene = read_text(
        "objects: [{name: b, sphere: {radius: 1}}]\nrobots: [{name: r, "
        "urdf: r.urdf" +
        keys + "}]\npairs: [{between: [r, b]}]\n");
    return scene.objects.at(1).parts.size();
  };
  EXPECT_EQ(parts(""), 2u) << errors_;
  EXPECT_EQ(parts(", tolerance: 0.2"), 1u) << errors_;
  EXPECT_EQ(parts(", max_parts: 1"), 1u) << errors_;
  EXPECT_THAT(told_, HasSubstr("[mesh-far-from-parts]"));
  EXPECT_THAT(told_, HasSubstr("raise max_parts (now 1) or tolerance in the cell ["));
}

// More grains, far from each other, than the number of parts that a mesh may have.
TriangleMesh dust() {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const Vec3 at(i % 7, i / 7, i % 3);
    for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(0.1, 0, 0), Vec3(0, 0.1, 0), Vec3(0, 0, 0.1)}) {
      mesh.vertices.push_back(at + corner);
    }
    for (const std::array<std::uint32_t, 3>& face :
         {std::array<std::uint32_t, 3>{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
      mesh.triangles.push_back({4 * i + face[0], 4 * i + face[1], 4 * i + face[2]});
    }
  }
  return mesh;
}

TEST_F(PartsOfMeshes, OfAUrdfAloneComeWithTheAdviceToWriteACell) {
  test::write_text(folder_ / "dust.obj", drawn::obj_of(dust()));
  test::write_text(folder_ / "r.urdf",
                   "<robot name='r'><link name='base'><collision><geometry><mesh "
                   "filename='dust.obj'/></geometry></collision></link><link name='tip'><collision>"
                   "<geometry><sphere radius='0.1'/></geometry></collision></link><joint name='j' "
                   "type='prismatic'><axis xyz='1 0 0'/><limit lower='0' upper='1' velocity='1'/>"
                   "<parent link='base'/><child link='tip'/></joint></robot>");
  test::write_text(folder_ / "r.srdf", "<robot name='r'></robot>");
  std::string told;
  const CellResult result =
      read_single_robot({.urdf = folder_ / "r.urdf", .srdf = folder_ / "r.srdf"},
                        {.tell = [&told](const std::string& line) { told += line + "\n"; }});
  const auto* errors = std::get_if<std::vector<CellError>>(&result);
  EXPECT_EQ(nullptr, errors) << errors->front().text;
  EXPECT_THAT(told, HasSubstr("clearance-scene new --robots URDF"));
}

TEST_F(PartsOfMeshes, RefuseLimitsThatMakeNoSense) {
  read(", tolerance: 0");
  EXPECT_THAT(errors_, mistake_at("cell.yaml:5:46", "0"));
  for (const char* parts : {"0", "65"}) {
    read(std::string(", max_parts: ") + parts);
    EXPECT_THAT(errors_, mistake_at("cell.yaml:5:46", parts));
  }
}

}  // namespace
}  // namespace clearance
