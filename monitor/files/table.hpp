// A table kept as CSV, plain or gzip: its columns are found by the names in its first line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace clearance {

// A subset of RFC 4180: fields are separated by commas and may be quoted, but contain neither
// commas nor line breaks.
// The names in the first line; empty: the file cannot be read, or has none.
[[nodiscard]] std::vector<std::string> csv_column_names(const std::filesystem::path& file);

class CsvTable {
 public:
  // `columns` must all be there, each once, in any order; others are ignored. A column is known by
  // its place in `columns` from here on; their text must outlive the table.
  CsvTable(const std::filesystem::path& file, std::span<const std::string_view> columns);

  // The next row that is not blank. False at the end and at the first mistake. After a mistake
  // error() reads "FILE:LINE: ...".
  [[nodiscard]] bool next();
  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  // "FILE:LINE: what", for what a caller finds wrong with the row just read.
  [[nodiscard]] std::string located(const std::string& what) const;

  // Cells of the row just read. Numbers are finite; times whole nanoseconds from 0 that do not go
  // back from row to row. False after an error.
  [[nodiscard]] std::string_view text(std::size_t column) const { return fields_[place_[column]]; }
  [[nodiscard]] bool number(std::size_t column, double& value);
  [[nodiscard]] bool time_ns(std::size_t column, std::int64_t& value);
  // Sets error() for the row just read and returns false.
  bool fail(const std::string& what);

 private:
  struct CloseGzip {
    void operator()(void* file) const;
  };

  bool fill_buffer();
  bool read_line(std::string& line);
  bool read_header();
  bool split(const std::string& line);

  std::filesystem::path path_;
  std::vector<std::string_view> columns_;
  std::unique_ptr<void, CloseGzip> file_;  // a gzFile
  std::string error_;
  std::size_t line_ = 0;
  std::int64_t last_t_ns_ = 0;
  std::vector<char> buffer_;              // read from the file
  std::size_t next_ = 0;                  // the first byte in `buffer_` that no line has taken
  std::string text_;                      // of the line
  std::vector<std::string_view> fields_;  // into text_
  std::vector<std::size_t> place_;        // by column
  std::size_t width_ = 0;                 // columns of the header
};

}  // namespace clearance
