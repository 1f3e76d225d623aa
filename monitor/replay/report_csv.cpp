// Builds rows in memory with std::to_chars, the shortest text that reads back exactly, and writes
// them in pieces of 256 KiB.
#include "monitor/replay/report_csv.hpp"

#include <array>
#include <charconv>

#include "monitor/files/file_error.hpp"
#include "monitor/monitor.hpp"

namespace clearance {
namespace {

// Large enough that writing takes no noticeable time for each tick.
constexpr std::size_t kWriteAt = std::size_t{1} << 18;  // bytes

// As RFC 4180 has it.
std::string quoted(const std::string& name) {
  if (name.find_first_of(",\"\n") == std::string::npos) return name;
  std::string out = "\"";
  for (const char c : name) out.append(c == '"' ? 2 : 1, c);
  return out + "\"";
}

// The shortest text that reads back as the same number.
template <class Number>
void put(std::string& row, Number value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  row.append(text.data(), end);
}

void put(std::string& row, const Vec3& vector) {
  for (int i = 0; i < 3; ++i) {
    row += ',';
    put(row, vector[i]);
  }
}

}  // namespace

// The header is the first row in memory; it reaches the file with the first piece.
ReportCsv::ReportCsv(const std::filesystem::path& file, const Scene& scene, bool all_pairs)
    : path_(file), scene_(scene), all_pairs_(all_pairs), file_(std::fopen(file.c_str(), "wb")) {
  if (!file_) {
    error_ = cannot_create(file);
    return;
  }
  for (const Object& object : scene.objects) names_.push_back(quoted(object.name));
  rows_ =
      "tick,now_ns,object_a,object_b,status,distance,lower,upper,swept_lower,ax,ay,az,bx,by,bz,nx,"
      "ny,nz,"
      "closing_speed,time_to_contact,age_a_ns,age_b_ns,refresh_age_cycles\n";
}

// Rows are collected and written in large pieces.
void ReportCsv::add(const ReplayedTick& tick) {
  if (!error_.empty()) return;
  if (all_pairs_) {
    for (std::uint32_t pair = 0; pair < scene_.pairs.size(); ++pair) {
      add_row(tick.report, tick.monitor.pair(pair));
    }
  } else {
    for (const PairReport& pair : tick.report.pairs) add_row(tick.report, pair);
  }
  if (rows_.size() >= kWriteAt) write();
}

// In the order of the header.
void ReportCsv::add_row(const Report& report, const PairReport& pair) {
  const ObjectPair& objects = scene_.pairs[pair.pair];
  put(rows_, report.cycle);
  rows_ += ',';
  put(rows_, report.now_ns);
  rows_.append(",").append(names_[objects.first]).append(",").append(names_[objects.second]);
  rows_.append(",").append(name(pair.status));
  for (const double value : {pair.distance, pair.lower, pair.upper, pair.swept_lower}) {
    rows_ += ',';
    put(rows_, value);
  }
  put(rows_, pair.witness_a);
  put(rows_, pair.witness_b);
  put(rows_, pair.normal);
  for (const double value : {pair.closing_speed, pair.time_to_contact}) {
    rows_ += ',';
    put(rows_, value);
  }
  for (const std::int64_t value : {pair.age_a_ns, pair.age_b_ns}) {
    rows_ += ',';
    put(rows_, value);
  }
  rows_ += ',';
  put(rows_, pair.refresh_age_cycles);
  rows_ += '\n';
}

// After an error the rows are dropped: the file is incomplete anyway.
void ReportCsv::write() {
  if (std::fwrite(rows_.data(), 1, rows_.size(), file_.get()) != rows_.size()) {
    error_ = cannot_write(path_);
  }
  rows_.clear();
}

// The last rows, and the errors that only closing shows (a full disk).
bool ReportCsv::close() {
  if (!file_) return error_.empty();
  if (error_.empty()) write();
  if (std::fclose(file_.release()) != 0 && error_.empty()) {
    error_ = cannot_write(path_);
  }
  return error_.empty();
}

}  // namespace clearance
