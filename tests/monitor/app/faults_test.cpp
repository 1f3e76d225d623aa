// monitor/FAULTS.md tells a person what to do about each line of the log, which its code finds.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "config/mesh/mesh_codes.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/intake/camera_messages.hpp"
#include "monitor/intake/pose_sources.hpp"
#include "monitor/interface/all_log_lines.hpp"
#include "tests/shared/places.hpp"

namespace clearance {
namespace {

std::string faults() {
  std::ostringstream text;
  text << std::ifstream(test::places::sources() + "/monitor/FAULTS.md").rdbuf();
  return text.str();
}

std::set<std::string> codes_of_the_log() {
  std::set<std::string> codes;
  std::apply([&](const auto&... line) { (codes.emplace(line.code), ...); }, lines::kAll);
  codes.insert(kMeshCodes.begin(), kMeshCodes.end());
  return codes;
}

// The codes that the page names: `[poses-late]`, in backticks.
std::set<std::string> codes_of(const std::string& page) {
  static constexpr std::string_view kBegin = "`[", kEnd = "]`";
  std::set<std::string> codes;
  for (std::size_t at = 0; (at = page.find(kBegin, at)) != std::string::npos;) {
    at += kBegin.size();
    codes.insert(page.substr(at, page.find(kEnd, at) - at));
  }
  return codes;
}

TEST(Faults, NameEachCodeOfTheLogAndNoOther) {
  const std::set<std::string> named = codes_of(faults()), logged = codes_of_the_log();
  for (const std::string& code : logged) {
    EXPECT_TRUE(named.contains(code)) << "monitor/FAULTS.md has no row for [" << code << "]";
  }
  for (const std::string& code : named) {
    EXPECT_TRUE(logged.contains(code)) << "no line of the log has [" << code << "]";
  }
}

TEST(Faults, NameEachCauseOfARefusal) {
  const std::string page = faults();
  const auto expect_row = [&](const std::string& cause) {
    EXPECT_NE(page.find(cause), page.npos) << "monitor/FAULTS.md lacks '" << cause << "'";
  };
  for (int cause = 0; cause < static_cast<int>(Reject::kCount); ++cause) {
    expect_row(name(static_cast<Reject>(cause)));
  }
  for (std::size_t fault = 1; fault < kFrameFaults; ++fault) {
    expect_row(name(static_cast<FrameFault>(fault)));
  }
  for (const SourceRefusal cause :
       {SourceRefusal::kTooMany, SourceRefusal::kOtherWriter, SourceRefusal::kNoName}) {
    expect_row(name(cause));
  }
}

}  // namespace
}  // namespace clearance
