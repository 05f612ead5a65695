#include "core/csv.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace core {
namespace {
constexpr auto kNone = std::string_view::npos;

bool is_blank(char c, char separator) { return c != separator && (c == ' ' || c == '\t'); }

std::size_t after_blanks(std::string_view text, std::size_t at, char separator) {
  while (at < text.size() && is_blank(text[at], separator)) ++at;
  return at;
}

/// Where the record at the front ends, its line's end included; none while that is not here.
std::size_t record_size(std::string_view text, char separator) {
  const std::size_t newline = text.find('\n');
  const char ends[] = {separator, '\n'};
  if (text.substr(0, newline).find('"') == kNone) return newline == kNone ? kNone : newline + 1;
  for (std::size_t at = 0;; ++at) {
    at = after_blanks(text, at, separator);
    if (at < text.size() && text[at] == '"') {
      do {
        at = text.find('"', at + 1);
        if (at == kNone) return kNone;
        ++at;
      } while (at < text.size() && text[at] == '"');
    }
    at = text.find_first_of(std::string_view(ends, 2), at);
    if (at == kNone) return kNone;
    if (text[at] == '\n') return at + 1;
  }
}

/// Takes the quotes away from the cell that begins at `at`, behind its first. Where its last was;
/// none when there is none.
std::size_t unquoted(std::span<char> record, std::size_t at, std::string_view& cell) {
  char* const begin = record.data() + at;
  char* to = begin;
  for (; at < record.size(); ++at) {
    if (record[at] == '"' && (at + 1 == record.size() || record[at + 1] != '"')) {
      cell = {begin, to};
      return at;
    }
    if (record[at] == '"') ++at;
    *to++ = record[at];
  }
  return kNone;
}

/// What is wrong with a record, or nothing.
const char* split(std::span<char> record, char separator, std::vector<std::string_view>& cells) {
  const std::string_view text(record.data(), record.size());
  cells.clear();
  for (std::size_t from = 0;; ++from) {
    std::size_t at = after_blanks(text, from, separator);
    std::string_view cell;
    if (at < text.size() && text[at] == '"') {
      at = unquoted(record, at + 1, cell);
      if (at == kNone) return "a quote stays open";
      from = after_blanks(text, at + 1, separator);
      if (from < text.size() && text[from] != separator) return "text follows a quoted cell";
    } else {
      from = std::min(text.find(separator, at), text.size());
      while (from > at && is_blank(text[from - 1], separator)) --from;
      cell = text.substr(at, from - at);
      from = std::min(text.find(separator, from), text.size());
    }
    cells.push_back(cell);
    if (from == text.size()) return nullptr;
  }
}

}  // namespace

CsvReader::CsvReader(std::span<char> text, std::string name, char separator)
    : name_(std::move(name)), separator_(separator), most_(text.size()), text_(text) {}

Result<CsvReader> CsvReader::open(const std::filesystem::path& path, std::size_t most_record_bytes,
                                  char separator) {
  CsvReader out({}, path.string(), separator);
  out.fd_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (out.fd_ < 0) return system_error(path, "cannot open");
  struct stat info {};
  if (::fstat(out.fd_, &info) != 0) return system_error(path, "cannot look at");
  if (!S_ISREG(info.st_mode))
    return Error{Errc::bad_input, fmt::format("{}: not a regular file", path.string())};
  out.most_ = most_record_bytes;
  out.buffer_.resize(std::max<std::size_t>(most_record_bytes + 2, 1u << 18));
  out.ended_ = false;
  return out;
}

CsvReader::~CsvReader() {
  if (fd_ >= 0) ::close(fd_);
}

CsvReader::CsvReader(CsvReader&& other) noexcept
    : name_(std::move(other.name_)),
      separator_(other.separator_),
      fd_(std::exchange(other.fd_, -1)),
      most_(other.most_),
      buffer_(std::move(other.buffer_)),
      text_(other.text_),
      ended_(other.ended_),
      line_(other.line_),
      next_line_(other.next_line_) {}

Error CsvReader::wrong(std::string_view why) const {
  return {Errc::bad_input, fmt::format("{}:{}: {}", name_, line_, why)};
}

Result<void> CsvReader::fill() {
  if (!text_.empty()) std::memmove(buffer_.data(), text_.data(), text_.size());
  const std::size_t held = text_.size();
  const ssize_t n = ::read(fd_, buffer_.data() + held, buffer_.size() - held);
  if (n < 0 && errno != EINTR) return system_error(name_, "cannot read");
  ended_ = n == 0;
  text_ = {buffer_.data(), held + std::size_t(std::max<ssize_t>(n, 0))};
  return {};
}

Result<std::span<char>> CsvReader::record() {
  std::size_t size = kNone;
  while ((size = record_size({text_.data(), text_.size()}, separator_)) == kNone && !ended_ &&
         text_.size() < most_ + 2)
    TRY(fill());
  auto out = text_.first(std::min(size, text_.size()));
  next_line_ += std::size_t(std::ranges::count(out, '\n'));
  const std::size_t taken = out.size();
  if (!out.empty() && out.back() == '\n') out = out.first(out.size() - 1);
  if (!out.empty() && out.back() == '\r') out = out.first(out.size() - 1);
  if (out.size() > most_)
    return wrong(fmt::format("the line is longer than {} bytes; is this a CSV file?", most_));
  text_ = text_.subspan(taken);
  return out;
}

Result<bool> CsvReader::next(std::vector<std::string_view>& cells) {
  while (text_.empty() && !ended_) TRY(fill());
  if (line_ == 0 && text_.size() < 3 && !ended_) TRY(fill());
  if (line_ == 0 && std::string_view(text_.data(), text_.size()).starts_with("\xef\xbb\xbf"))
    text_ = text_.subspan(3);
  if (text_.empty()) return false;
  line_ = next_line_;
  const auto taken = TRY(record());
  if (const char* why = split(taken, separator_, cells)) return wrong(why);
  return true;
}

std::string csv_cell(std::string_view text) {
  const auto is_edge = [](char c) { return c == ' ' || c == '\t'; };
  const bool plain = text.find_first_of(",\"\r\n") == kNone &&
                     (text.empty() || (!is_edge(text.front()) && !is_edge(text.back())));
  if (plain) return std::string(text);
  std::string out = "\"";
  for (const char c : text) out.append(c == '"' ? 2 : 1, c);
  return out + '"';
}

std::string csv_person_cell(std::string_view text) {
  const bool formula = !text.empty() && std::string_view("=+-@\t\r").find(text.front()) != kNone;
  return csv_cell(formula ? '\'' + std::string(text) : std::string(text));
}

}  // namespace core
}  // namespace tractus
