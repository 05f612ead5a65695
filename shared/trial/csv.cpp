#include "trial/csv.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace trial {
namespace {

using core::Errc;
using core::Error;
using core::Result;

/// A regular file's lines, one at a time, through one buffer.
class Lines {
 public:
  static Result<Lines> open(const std::filesystem::path& path, std::size_t max_line_bytes) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return core::system_error(path, "cannot open");
    Lines lines(fd, path, max_line_bytes);
    struct stat info {};
    if (::fstat(fd, &info) != 0) return core::system_error(path, "cannot look at");
    if (!S_ISREG(info.st_mode))
      return Error{Errc::bad_input, fmt::format("{}: not a regular file", path.string())};
    return lines;
  }
  ~Lines() {
    if (fd_ >= 0) ::close(fd_);
  }
  Lines(Lines&& other) noexcept
      : fd_(std::exchange(other.fd_, -1)),
        path_(std::move(other.path_)),
        max_(other.max_),
        buffer_(std::move(other.buffer_)) {}
  Lines& operator=(Lines&&) = delete;

  /// The next line without its end, valid until the next call; nothing after the last.
  Result<std::optional<std::string_view>> next() {
    for (;;) {
      const auto* start = buffer_.data() + begin_;
      const auto* newline = static_cast<const char*>(std::memchr(start, '\n', end_ - begin_));
      if (newline) {
        std::string_view line(start, std::size_t(newline - start));
        begin_ += line.size() + 1;
        return taken(line);
      }
      if (ended_) {
        if (begin_ == end_) return std::optional<std::string_view>{};
        std::string_view line(start, end_ - begin_);
        begin_ = end_;
        return taken(line);
      }
      TRY(fill());
    }
  }
  std::size_t line() const { return line_; }

 private:
  Lines(int fd, std::filesystem::path path, std::size_t max)
      : fd_(fd),
        path_(std::move(path)),
        max_(max),
        buffer_(std::max<std::size_t>(max + 2, 1u << 18)) {}

  Result<std::optional<std::string_view>> taken(std::string_view line) {
    ++line_;
    if (line.size() > max_ + 1) return too_long();
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return std::optional(line);
  }
  Error too_long() const {
    return {Errc::bad_input,
            fmt::format("{}:{}: the line is longer than {} bytes; is this a CSV file?",
                        path_.string(), line_, max_)};
  }
  Result<void> fill() {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    if (end_ == buffer_.size()) return ++line_, too_long();
    const ssize_t n = ::read(fd_, buffer_.data() + end_, buffer_.size() - end_);
    if (n < 0 && errno != EINTR) return core::system_error(path_, "cannot read");
    if (n == 0) ended_ = true;
    if (n > 0) end_ += std::size_t(n);
    return {};
  }

  int fd_;
  std::filesystem::path path_;
  std::size_t max_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0, line_ = 0;
  bool ended_ = false;
};

std::string_view trimmed(std::string_view cell) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!cell.empty() && blank(cell.front())) cell.remove_prefix(1);
  while (!cell.empty() && blank(cell.back())) cell.remove_suffix(1);
  return cell;
}

/// Where a cell that begins at `from` ends: the next comma outside quotes, or the line's end.
std::size_t end_of_cell(std::string_view line, std::size_t from) {
  std::size_t at = from;
  while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
  if (at < line.size() && line[at] == '"') {
    for (++at; at < line.size(); ++at)
      if (line[at] == '"' && (at + 1 == line.size() || line[++at] != '"')) break;
  }
  return std::min(line.find(',', at), line.size());
}

void split(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (std::size_t from = 0;;) {
    const std::size_t end = end_of_cell(line, from);
    std::string_view cell = trimmed(line.substr(from, end - from));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
      cell = trimmed(cell.substr(1, cell.size() - 2));
    cells.push_back(cell);
    if (end == line.size()) return;
    from = end + 1;
  }
}

/// A cell as it may stand in a one-line message.
std::string shown(std::string_view cell) {
  std::string out;
  for (const char c : cell.substr(0, 40))
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? std::string("?") : std::string(1, c);
  while (cell.size() > 40 && !out.empty() && (static_cast<unsigned char>(out.back()) & 0x80))
    out.pop_back();
  return cell.size() > 40 ? out + "…" : out;
}

/// What is wrong with a cell as a number, or nothing.
std::string parsed(std::string_view cell, double& out) {
  if (cell.empty()) return "the cell is empty, a number is expected";
  std::string_view digits = cell;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), out);
  if (failure == std::errc::result_out_of_range)
    return fmt::format("'{}' is beyond what a number can hold", shown(cell));
  if (failure != std::errc{} || end != digits.data() + digits.size())
    return fmt::format("'{}' is not a number", shown(cell));
  if (!std::isfinite(out)) return fmt::format("'{}' is not a finite number", shown(cell));
  return {};
}

std::string missing_column(std::string_view column, std::string_view header) {
  std::string hint;
  if (header.find(',') == std::string_view::npos &&
      header.find_first_of(";\t") != std::string_view::npos)
    hint = "; cells must be separated by commas";
  else if (header.starts_with("\xff\xfe") || header.starts_with("\xfe\xff"))
    hint = "; the text must be UTF-8, this is UTF-16";
  else if (!header.empty() && header[0] != '"' &&
           (header[0] == '-' || (header[0] >= '0' && header[0] <= '9')))
    hint = "; the first line must name the columns";
  return fmt::format("column {} is missing{}", column, hint);
}

/// Places of the asked columns in the header, or what is wrong.
std::string find_columns(std::string_view header, std::span<const std::string_view> columns,
                         std::vector<std::size_t>& places, std::size_t& width) {
  std::vector<std::string_view> names;
  split(header, names);
  width = names.size();
  for (const auto column : columns) {
    const auto found = std::ranges::find(names, column);
    if (found == names.end()) return missing_column(column, header);
    if (std::find(found + 1, names.end(), column) != names.end())
      return fmt::format("column {} stands there twice", column);
    places.push_back(std::size_t(found - names.begin()));
  }
  return {};
}

}  // namespace

Result<std::size_t> read_csv(const std::filesystem::path& path,
                             std::span<const std::string_view> columns, const CsvRow& on_row,
                             const CsvLimits& limits) {
  auto lines = TRY(Lines::open(path, limits.max_line_bytes));
  const auto wrong = [&](std::size_t line, const std::string& why, Errc code = Errc::bad_input) {
    return Error{code, fmt::format("{}:{}: {}", path.string(), line, why)};
  };
  std::vector<std::size_t> places;
  std::vector<std::string_view> cells;
  std::vector<double> values(columns.size());
  std::size_t rows = 0, width = 0, empty_line = 0;
  for (;;) {
    const auto line = TRY(lines.next());
    if (!line) break;
    std::string_view text = *line;
    if (lines.line() == 1) {
      if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
      if (auto why = find_columns(text, columns, places, width); !why.empty()) return wrong(1, why);
      continue;
    }
    if (trimmed(text).empty()) {
      if (empty_line == 0) empty_line = lines.line();
      continue;
    }
    if (empty_line != 0) return wrong(empty_line, "the line is empty, a row is expected");
    if (++rows > limits.max_rows)
      return wrong(lines.line(), fmt::format("more than {} rows", limits.max_rows),
                   Errc::too_large);
    split(text, cells);
    if (cells.size() != width)
      return wrong(lines.line(), fmt::format("{} cells, the header has {}", cells.size(), width));
    for (std::size_t c = 0; c < places.size(); ++c)
      if (auto why = parsed(cells[places[c]], values[c]); !why.empty())
        return wrong(lines.line(), fmt::format("column {}: {}", columns[c], why));
    if (auto why = on_row(lines.line(), values); !why.empty()) return wrong(lines.line(), why);
  }
  if (lines.line() == 0) return wrong(1, "the file is empty, a header is expected");
  return rows;
}

Result<std::vector<std::string>> csv_header(const std::filesystem::path& path,
                                            const CsvLimits& limits) {
  auto lines = TRY(Lines::open(path, limits.max_line_bytes));
  const auto line = TRY(lines.next());
  if (!line)
    return Error{Errc::bad_input,
                 fmt::format("{}:1: the file is empty, a header is expected", path.string())};
  std::string_view text = *line;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  std::vector<std::string_view> names;
  split(text, names);
  return std::vector<std::string>(names.begin(), names.end());
}

}  // namespace trial
}  // namespace tractus
