#include "monitor/record/csv_poses.hpp"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "config/spelling.hpp"
#include "monitor/batch.hpp"
#include "monitor/record/recording_writer.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

constexpr std::array<std::string_view, 9> kColumnNames = {"t_ns", "object", "px", "py", "pz",
                                                          "qw",   "qx",     "qy", "qz"};
enum Column : std::size_t { kTime, kObject, kX, kY, kZ, kW, kQx, kQy, kQz };

constexpr std::string_view kSource = "csv";

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n\"";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

// Ids for the objects of a log.
class Ids {
 public:
  explicit Ids(const Scene* scene) : scene_(scene) {
    if (scene == nullptr) return;
    for (const Object& object : scene->objects) add(object.name);
  }

  // False: the scene has no such object.
  bool know(const std::string& name) {
    if (ids_.contains(name)) return true;
    if (scene_ != nullptr) return false;
    add(name);
    return true;
  }
  [[nodiscard]] std::uint32_t id(const std::string& name) const { return ids_.at(name); }
  [[nodiscard]] bool fixed(const std::string& name) const {
    return scene_ != nullptr && scene_->objects[id(name)].fixed;
  }
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }

 private:
  void add(const std::string& name) {
    ids_.emplace(name, static_cast<std::uint32_t>(names_.size()));
    names_.push_back(name);
  }

  const Scene* scene_;
  std::vector<std::string> names_;
  std::map<std::string, std::uint32_t> ids_;
};

// The first pass: everything that can be wrong with the log.
void check(const std::filesystem::path& csv, Ids& ids, CsvRecordingResult& result) {
  CsvPoseLog log(csv);
  CsvPose pose;
  while (log.next(pose)) {
    if (!ids.know(pose.object)) {
      result.error = log.located("the cell has no object '" + pose.object + "'" +
                                 did_you_mean(pose.object, ids.names()));
      return;
    }
    if (result.rows++ == 0) result.first_ns = pose.t_ns;
    result.last_ns = pose.t_ns;
    if (std::ranges::find(result.objects, pose.object) != result.objects.end()) continue;
    result.objects.push_back(pose.object);
    if (ids.fixed(pose.object)) result.fixed_objects.push_back(pose.object);
  }
  result.error = log.error();
  if (result.error.empty() && result.rows == 0) result.error = csv.string() + " has no rows";
}

Scene scene_of(const std::filesystem::path& csv, const std::vector<std::string>& objects) {
  Scene scene;
  scene.name = csv.stem().stem().string();
  for (const std::string& name : objects) scene.objects.emplace_back().name = name;
  return scene;
}

// The second pass: one batch a time, more when it has more poses than a batch can hold.
class BatchWriter {
 public:
  BatchWriter(RecordingWriter& out, std::uint64_t scene_revision)
      : out_(out), wire_(make_batch(clearance_msg_kMaxPoses)) {
    batch_.source = SourceName(kSource);
    batch_.scene_revision = scene_revision;
  }

  void add(std::uint32_t id, const CsvPose& pose) {
    const bool same_time = !batch_.samples.empty() && batch_.samples.back().stamp_ns == pose.t_ns;
    if (!same_time || batch_.samples.size() == clearance_msg_kMaxPoses) flush();
    PoseSample& sample = batch_.samples.emplace_back();
    sample.object = id;
    sample.stamp_ns = pose.t_ns;
    sample.world_from_object = pose.world_from_object;
  }

  void flush() {
    if (batch_.samples.empty()) return;
    ++batch_.sequence_number;
    to_wire(batch_, *wire_);
    const std::int64_t t_ns = batch_.samples.front().stamp_ns;
    out_.write(TopicKind::kPoses, t_ns, t_ns, *wire_);
    batch_.samples.clear();
  }

  [[nodiscard]] std::uint64_t written() const noexcept { return batch_.sequence_number; }

 private:
  RecordingWriter& out_;
  PoseBatch batch_;
  Sample<clearance_msg_PoseBatch> wire_;
};

}  // namespace

void CsvPoseLog::CloseGzip::operator()(void* file) const { gzclose(static_cast<gzFile>(file)); }

CsvPoseLog::CsvPoseLog(const std::filesystem::path& file)
    : path_(file), file_(gzopen(file.c_str(), "rb")) {
  if (!file_) {
    error_ = "cannot read " + file.string();
    return;
  }
  gzbuffer(static_cast<gzFile>(file_.get()), 1 << 18);
  read_header();
}

std::string CsvPoseLog::located(const std::string& what) const {
  return path_.string() + ":" + std::to_string(line_) + ": " + what;
}

bool CsvPoseLog::fail(const std::string& what) {
  error_ = located(what);
  return false;
}

bool CsvPoseLog::read_line(std::string& line) {
  line.clear();
  auto* const file = static_cast<gzFile>(file_.get());
  std::array<char, 512> piece;
  while (gzgets(file, piece.data(), static_cast<int>(piece.size())) != nullptr) {
    line += piece.data();
    if (line.back() == '\n') break;
  }
  int status = Z_OK;
  const char* const what = gzerror(file, &status);
  if (status != Z_OK && status != Z_STREAM_END) {
    ++line_;
    return fail(std::string("cannot be read any further: ") + what);
  }
  if (line.empty()) return false;
  ++line_;
  return true;
}

bool CsvPoseLog::split(const std::string& line) {
  fields_.clear();
  std::string_view rest = line;
  for (;;) {
    const std::size_t comma = rest.find(',');
    fields_.push_back(trimmed(rest.substr(0, comma)));
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  return fields_.size() > 1 || !fields_.front().empty();  // false: a blank line
}

bool CsvPoseLog::read_header() {
  if (!read_line(text_)) return error_.empty() ? fail("is empty") : false;
  if (text_.starts_with("\xef\xbb\xbf")) text_.erase(0, 3);  // byte order mark
  split(text_);
  width_ = fields_.size();
  for (std::size_t column = 0; column < kColumns; ++column) {
    const auto found = std::ranges::find(fields_, kColumnNames[column]);
    if (found == fields_.end()) {
      return fail("no column '" + std::string(kColumnNames[column]) +
                  "'; the first line must name t_ns,object,px,py,pz,qw,qx,qy,qz in any order");
    }
    place_[column] = static_cast<std::size_t>(found - fields_.begin());
  }
  return true;
}

bool CsvPoseLog::read_number(std::size_t column, double& value) {
  const std::string_view field = fields_[place_[column]];
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error == std::errc{} && end == field.data() + field.size() && std::isfinite(value))
    return true;
  return fail(std::string(kColumnNames[column]) + " is '" + std::string(field) +
              "', which is not a finite number");
}

bool CsvPoseLog::next(CsvPose& pose) {
  if (!error_.empty()) return false;
  do {
    if (!read_line(text_)) return false;
  } while (!split(text_));
  if (fields_.size() != width_) {
    return fail("has " + std::to_string(fields_.size()) + " fields, the header names " +
                std::to_string(width_));
  }
  const std::string_view time = fields_[place_[kTime]];
  const auto [end, error] = std::from_chars(time.data(), time.data() + time.size(), pose.t_ns);
  if (error != std::errc{} || end != time.data() + time.size() || pose.t_ns < 0) {
    return fail("t_ns is '" + std::string(time) + "', which is not a whole number of nanoseconds");
  }
  if (pose.t_ns < last_t_ns_) {
    return fail("t_ns goes back from " + std::to_string(last_t_ns_) + " to " + std::string(time) +
                "; sort the log by t_ns");
  }
  last_t_ns_ = pose.t_ns;
  pose.object = fields_[place_[kObject]];
  if (pose.object.empty()) return fail("names no object");
  for (int i = 0; i < 3; ++i) {
    if (!read_number(kX + static_cast<std::size_t>(i), pose.world_from_object.position[i])) {
      return false;
    }
  }
  Eigen::Quaterniond& q = pose.world_from_object.orientation;
  return read_number(kW, q.w()) && read_number(kQx, q.x()) && read_number(kQy, q.y()) &&
         read_number(kQz, q.z());
}

CsvRecordingResult record_csv(const std::filesystem::path& csv, const std::filesystem::path& out,
                              const Scene* scene) {
  CsvRecordingResult result;
  Ids ids(scene);
  check(csv, ids, result);
  if (!result.error.empty()) return result;

  const Scene made = scene == nullptr ? scene_of(csv, ids.names()) : Scene{};
  const Scene& named = scene == nullptr ? made : *scene;
  RecordingWriter writer(out, named.topics);
  writer.catalogue(*make_catalogue(named), result.first_ns);
  BatchWriter batches(writer, named.revision);
  CsvPoseLog log(csv);
  CsvPose pose;
  while (log.next(pose)) {
    if (!ids.fixed(pose.object)) batches.add(ids.id(pose.object), pose);
  }
  batches.flush();
  result.samples = static_cast<std::size_t>(batches.written());
  if (!writer.close()) result.error = writer.error();
  return result;
}

}  // namespace clearance
