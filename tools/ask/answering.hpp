// Answers motions of a file or a bag, one after another or in several threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/ask/asked_motion.hpp"
#include "tools/ask/bag_motions.hpp"
#include "tools/ask/motion_report.hpp"

namespace clearance {

struct AskOptions {
  std::string cell, motions, out;
  // m, or with names: "A,B=0.05", "ZONE=0.05".
  std::vector<std::string> margins{"0", "0.01", "0.05"};
  std::vector<std::string> without;  // sensors
  double tolerance = 1e-3;
  std::optional<double> expected;
  bool others_still = false, stoppable = false, only_verdicts = false;
  int repeat = 1;
  unsigned threads = 1;
  MotionReportFiles files;
};

class Answering {
 public:
  // The options must outlive this.
  explicit Answering(const AskOptions& options);
  // Returns what is wrong with the options; empty: nothing.
  [[nodiscard]] std::string read_margins();
  // Reads the cell of all motions; a folder is read as motions name its cells.
  [[nodiscard]] bool read();
  [[nodiscard]] std::string begin_report();
  // A motion a line. Both return the exit status.
  int answer_all(std::istream& in, std::ostream& out);
  // The motions of a bag, which is read twice.
  int answer_bag(std::ostream& out);

 private:
  // Several threads answer so many motions each at a time.
  static constexpr std::size_t kWaitingForThread = 256;

  std::string answer(const std::vector<BagMotion>& motions, std::ostream& out);
  // The bag may change the cell.
  AskedPlace& place_of(const Cell& cell);
  // One thread answers each motion at once; with several of them it may wait.
  void take(AskedMotion motion, std::ostream& out);
  void ask(AskedMotion& motion);
  // Place by place, since the memory for questions is that of one scene.
  void answer_waiting(std::ostream& out);
  void write(AskedMotion& motion, std::ostream& out);
  // `error` says why the input could not be read to its end.
  int conclude(std::string error, const std::string& expected, std::ostream& out);
  bool add(const std::string& scene, const std::filesystem::path& file);
  AskedPlace& place_of(const nlohmann::json& motion);
  // The expected distance is the last of the margins of all pairs.
  void expect(AskedMotion& motion);
  void summarise();

  const AskOptions& options_;
  Question defaults_;
  MotionReport report_;
  std::vector<AskedMotion> waiting_;
  std::map<std::string, std::unique_ptr<AskedPlace>> places_;
  std::vector<double> times_us_;
  std::size_t lines_ = 0, bad_ = 0, undecided_ = 0, failed_ = 0, bad_cells_ = 0;
};

}  // namespace clearance
