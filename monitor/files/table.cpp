// zlib reads the lines, since it reads plain files as well as gzip. A line is split into views of
// its text, so a row allocates nothing once the buffers have grown.
#include "monitor/files/table.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "config/text/file_bytes.hpp"
#include "monitor/files/file_error.hpp"

namespace clearance {
namespace {

// A row of 10,000 joints has a fifth of this.
constexpr std::size_t kLongestLine = std::size_t{1} << 20;

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

// Quotes are stripped, not parsed: no column of ours holds a comma.
std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n\"";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

// The whole text as a number.
template <class Number>
bool parsed(std::string_view text, Number& value) {
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc{} && result.ptr == end;
}

// For messages.
std::string joined(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) text.append(text.empty() ? "" : ",").append(name);
  return text;
}

// Null: it was not opened. A FIFO is not waited for.
gzFile open_gzip(const std::filesystem::path& path) noexcept {
  const int file = open_to_read(path);
  const gzFile opened = file < 0 ? nullptr : gzdopen(file, "rb");
  if (file >= 0 && opened == nullptr) ::close(file);
  return opened;
}

}  // namespace

// Reads at most kLongestLine bytes of the first line, because a file that is no table may have no
// line end.
std::vector<std::string> csv_column_names(const std::filesystem::path& file) {
  constexpr std::size_t kUsualLine = 65536;
  std::vector<std::string> names;
  const gzFile opened = open_gzip(file);
  if (opened == nullptr) return names;
  std::string line(kUsualLine, '\0');
  const bool read = gzgets(opened, line.data(), static_cast<int>(line.size())) != nullptr;
  gzclose(opened);
  if (!read) return names;
  line.resize(line.find('\0'));
  if (line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
  std::string_view rest = line;
  for (std::size_t comma = 0; comma != std::string_view::npos;) {
    comma = rest.find(',');
    names.emplace_back(trimmed(rest.substr(0, comma)));
    if (comma != std::string_view::npos) rest.remove_prefix(comma + 1);
  }
  return names;
}

// unique_ptr needs a deleter; void keeps zlib.h out of the header.
void CsvTable::CloseGzip::operator()(void* file) const { gzclose(static_cast<gzFile>(file)); }

// A larger buffer than zlib's 8 KiB: pose logs have millions of lines.
CsvTable::CsvTable(const std::filesystem::path& file, std::span<const std::string_view> columns)
    : path_(file),
      columns_(columns.begin(), columns.end()),
      file_(open_gzip(file)),
      place_(columns.size()) {
  if (!file_) {
    error_ = cannot_read(file);
    return;
  }
  gzbuffer(static_cast<gzFile>(file_.get()), 1 << 18);
  read_header();
}

// Lines count from 1, the header included.
std::string CsvTable::located(const std::string& what) const {
  return fmt::format("{}:{}: {}", path_.string(), line_, what);
}

// After the first error every further call fails, too.
bool CsvTable::fail(const std::string& what) {
  error_ = located(what);
  return false;
}

// Reads gzip and plain files alike, since zlib reads both. Returns false at the end of the file.
bool CsvTable::fill_buffer() {
  constexpr std::size_t kBufferSize = std::size_t{1} << 16;
  buffer_.resize(kBufferSize);
  const int count = gzread(static_cast<gzFile>(file_.get()), buffer_.data(), kBufferSize);
  buffer_.resize(static_cast<std::size_t>(std::max(count, 0)));
  next_ = 0;
  return count > 0;
}

// A small gzip file can hold a line that exceeds all memory, hence the limit.
bool CsvTable::read_line(std::string& line) {
  line.clear();
  bool ends = false;
  while (!ends && (next_ < buffer_.size() || fill_buffer())) {
    const auto begin = buffer_.begin() + static_cast<std::ptrdiff_t>(next_);
    const auto end = std::find(begin, buffer_.end(), '\n');
    ends = end != buffer_.end();
    line.append(begin, ends ? end + 1 : end);
    next_ = static_cast<std::size_t>(end - buffer_.begin()) + (ends ? 1 : 0);
    if (line.size() <= kLongestLine) continue;
    ++line_;
    return fail(fmt::format("is longer than {} MiB; expected a table of text with a row a line",
                            kLongestLine >> 20));
  }
  int status = Z_OK;
  const char* const what = gzerror(static_cast<gzFile>(file_.get()), &status);
  if (!ends && status != Z_OK && status != Z_STREAM_END) {
    ++line_;
    return fail(std::string("cannot be read any further: ") + what);
  }
  if (line.empty()) return false;
  ++line_;
  return true;
}

// The fields are views into the line, which lives until the next one is read.
bool CsvTable::split(const std::string& line) {
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

// Finds each column's place by its name; a column that is there twice is ambiguous.
bool CsvTable::read_header() {
  const std::string expected = fmt::format(
      "; expected a first line that names {}, each once, in any order", joined(columns_));
  if (!read_line(text_)) {
    if (!error_.empty()) return false;
    line_ = 1;
    return fail(fmt::format("is empty{}", expected));
  }
  if (text_.starts_with(kByteOrderMark)) text_.erase(0, kByteOrderMark.size());
  split(text_);
  width_ = fields_.size();
  for (std::size_t column = 0; column < columns_.size(); ++column) {
    const std::string name(columns_[column]);
    const auto found = std::ranges::find(fields_, columns_[column]);
    if (found == fields_.end()) return fail(fmt::format("no column '{}'{}", name, expected));
    if (std::find(found + 1, fields_.end(), columns_[column]) != fields_.end()) {
      return fail(fmt::format("two columns are named '{}'{}", name, expected));
    }
    place_[column] = static_cast<std::size_t>(found - fields_.begin());
  }
  return true;
}

// A row with more or fewer fields than the header is refused: its columns may be shifted.
bool CsvTable::next() {
  if (!error_.empty()) return false;
  do {
    if (!read_line(text_)) return false;
  } while (!split(text_));
  if (fields_.size() == width_) return true;
  return fail(
      fmt::format("has {} fields; expected {}, as the header names", fields_.size(), width_));
}

// std::from_chars depends on no locale; nan and inf are refused.
bool CsvTable::number(std::size_t column, double& value) {
  if (parsed(text(column), value) && std::isfinite(value)) return true;
  return fail(fmt::format("{} is '{}'; expected a finite number", columns_[column], text(column)));
}

// Times must not go back: replays and batches rely on the order of rows.
bool CsvTable::time_ns(std::size_t column, std::int64_t& value) {
  const std::string name(columns_[column]);
  const std::string found(text(column));
  if (!parsed(text(column), value) || value < 0) {
    return fail(fmt::format("{} is '{}'; expected whole nanoseconds, 0 or more", name, found));
  }
  if (value < last_t_ns_) {
    return fail(fmt::format("{} goes back from {} to {}; sort the log by {}", name, last_t_ns_,
                            found, name));
  }
  last_t_ns_ = value;
  return true;
}

}  // namespace clearance
