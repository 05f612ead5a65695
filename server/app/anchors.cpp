#include "server/app/anchors.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>

#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/operations/coverage.hpp"
#include "server/app/log.hpp"

namespace tractus {
namespace app {
namespace fs = std::filesystem;
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr std::uint64_t kMostLine_bytes = 4096;
/// Of the trail before its first row.
const std::string kNoHash(64, '0');
constexpr const char* kAnchorLabel = "anchor";
constexpr const char* kHighWaterLabel = "high water";

std::string mac_of(const store::AuditKey& key, const char* label, const Anchor& anchor) {
  return store::keyed_hash(key, {label, std::to_string(anchor.end.number), anchor.end.hash,
                                 std::to_string(anchor.count), std::to_string(anchor.at_utc_us)});
}

std::optional<std::int64_t> number_of(const std::string& text) {
  std::int64_t out = 0;
  const char* end = text.data() + text.size();
  const auto [at, failure] = std::from_chars(text.data(), end, out);
  return failure == std::errc() && at == end && out >= 0 ? std::optional(out) : std::nullopt;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> out;
  for (std::string word; in >> word;) out.push_back(word);
  return out;
}

/// The last five words of a line, or two of an old one.
std::optional<Anchor> anchor_of(const std::string& line) {
  std::vector<std::string> words = words_of(line);
  const bool old = words.size() == 2;
  if (!old && words.size() < 5) return std::nullopt;
  if (!old) words.erase(words.begin(), words.end() - 5);
  const auto row = number_of(words[0]);
  if (!row || !core::is_sha256(words[1])) return std::nullopt;
  Anchor out{{*row, words[1]}};
  if (old) return out;
  const auto count = number_of(words[2]), at = number_of(words[3]);
  if (!count || *count == 0 || !at || !core::is_sha256(words[4])) return std::nullopt;
  out.count = *count;
  out.at_utc_us = *at;
  out.mac = words[4];
  return out;
}

/// Lines that have their end; what a crash left of one is no line.
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::size_t from = 0;
  for (std::size_t end = 0; (end = text.find('\n', from)) != std::string::npos; from = end + 1)
    out.push_back(text.substr(from, end - from));
  return out;
}

/// In bounded memory. Errors: not_found, io.
Result<void> each_line(const fs::path& path, const std::function<void(const std::string&)>& seen) {
  std::ifstream file(path);
  if (!file) return core::system_error(path, "cannot open");
  for (std::string line; std::getline(file, line) && !file.eof();) seen(line);
  return {};
}

Error broken(const fs::path& path, const std::string& why) {
  return {Errc::corrupt, path.string() + ": " + why};
}

/// Nothing: there is none. Errors: io; corrupt when it was not written with this key.
Result<std::optional<Anchor>> high_water_of(const fs::path& data, const store::AuditKey& key) {
  const fs::path path = data / kHighWater;
  auto bytes = core::read_file(path, kMostLine_bytes);
  if (!bytes && bytes.error().code == Errc::not_found) return std::optional<Anchor>();
  if (!bytes) return bytes.error();
  const auto lines = lines_of(std::string(core::text_of(*bytes)));
  const auto anchor = lines.size() == 1 ? anchor_of(lines.front()) : std::nullopt;
  if (anchor && anchor->count > 0 && anchor->mac == mac_of(key, kHighWaterLabel, *anchor))
    return anchor;
  return broken(path, "was not written with this server's key, or was changed");
}

/// The end of a file, whole lines alone: at most so many bytes of it.
std::string tail_of(const fs::path& path) {
  std::error_code failure;
  const auto size = fs::file_size(path, failure);
  if (failure) return "";
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(size - std::min(size, kMostLine_bytes)));
  return std::string(std::istreambuf_iterator<char>(file), {});
}

/// The newest line of audit.anchor; one of count 0 when there is none.
Result<Anchor> newest_line(const fs::path& path, const store::AuditKey& key) {
  const auto lines = lines_of(tail_of(path));
  if (lines.empty()) return Anchor{};
  const auto anchor = anchor_of(lines.back());
  if (!anchor) return broken(path, "its last line is not an anchor");
  if (anchor->count > 0 && anchor->mac != mac_of(key, kAnchorLabel, *anchor))
    return broken(path, "its last line was not written with this server's key, or was changed");
  return *anchor;
}

Result<void> append_line(const fs::path& path, const std::string& line) {
  const std::string tail = tail_of(path);
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (fd < 0) return core::system_error(path, "cannot open");
  const auto torn = static_cast<off_t>(tail.size() - (tail.rfind('\n') + 1));  // npos + 1 is 0
  const off_t end = ::lseek(fd, 0, SEEK_END) - torn;
  const std::string text = line + "\n";
  const bool written =
      (torn == 0 || ::ftruncate(fd, end) == 0) &&
      ::pwrite(fd, text.data(), text.size(), end) == static_cast<ssize_t>(text.size()) &&
      ::fsync(fd) == 0;
  ::close(fd);
  if (!written) return core::system_error(path, "cannot write");
  return core::sync_folder(path.parent_path());
}

Result<void> write_high_water(const fs::path& data, const store::AuditKey& key, Anchor anchor) {
  anchor.mac = mac_of(key, kHighWaterLabel, anchor);
  return core::write_file(data / kHighWater, core::bytes_of(anchor.line() + "\n"));
}

struct TrailState {
  store::ChainEnd end, noted;
  bool covered = false;
};

Result<TrailState> trail_state(store::Store& store, std::int64_t noted) {
  return store.read([&](store::Reading& tx) -> Result<TrailState> {
    auto end = TRY(store::chain_end(tx));
    if (end.number == 0) end.hash = kNoHash;
    auto row = TRY(tx.query("select number, hash from audit where number = ?", {noted}));
    auto covered = TRY(tx.query("select count(*) from audit where what = 'beginCoverage'"));
    TrailState out{end, {}, covered.front().integer(0) > 0};
    if (!row.empty()) out.noted = {row.front().integer(0), row.front().text(1)};
    return out;
  });
}

struct Newest {
  Anchor anchor;                ///< of audit.anchor; of count 0 when there is none
  std::int64_t high_water = 0;  ///< the count in audit.highwater; 0: there is none
};

Result<Newest> newest_anchor(const fs::path& data, const store::AuditKey& key) {
  auto high = TRY(high_water_of(data, key));
  auto line = TRY(newest_line(data / kAnchors, key));
  const Newest out{line, high ? high->count : 0};
  if (out.high_water > line.count)
    return broken(data / kAnchors,
                  fmt::format("ends with anchor {}, but {} were made", line.count, out.high_water));
  return out;
}

Result<void> check_against(const DataFolder& data, const Newest& newest, const TrailState& trail) {
  if (trail.covered && newest.high_water == 0) return broken(data.path / kHighWater, "is missing");
  const store::ChainEnd& end = newest.anchor.end;
  if (end.number == 0 || trail.noted.hash == end.hash) return {};
  return Error{
      Errc::corrupt,
      fmt::format("audit trail: row {} differs from its anchor, or was cut off", end.number)};
}

}  // namespace

std::string Anchor::line() const {
  if (count == 0) return fmt::format("{} {}", end.number, end.hash);
  return fmt::format("{} {} {} {} {}", end.number, end.hash, count, at_utc_us, mac);
}

std::optional<Anchor> newest_anchor(const DataFolder& data) {
  const auto newest = newest_anchor(data.path, data.store.audit_key());
  return newest && newest->anchor.count > 0 ? std::optional(newest->anchor) : std::nullopt;
}

Result<std::optional<Anchor>> note_anchor(DataFolder& data) {
  using Maybe = std::optional<Anchor>;
  const auto held = data.store.hold("audit anchor");  // several servers share the file
  if (!held) return held.error();
  const store::AuditKey& key = data.store.audit_key();
  auto newest = TRY(newest_anchor(data.path, key));
  auto trail = TRY(trail_state(data.store, newest.anchor.end.number));
  TRY(check_against(data, newest, trail));
  Anchor anchor = newest.anchor;
  if (anchor.count == 0 || anchor.end.number != trail.end.number) {
    anchor = {trail.end, anchor.count + 1, core::utc_us()};
    anchor.mac = mac_of(key, kAnchorLabel, anchor);
    TRY(append_line(data.path / kAnchors, anchor.line()));
  }
  if (anchor.count == newest.high_water) return Maybe();
  TRY(write_high_water(data.path, key, anchor));
  return Maybe(anchor);
}

namespace {

/// Anchors of a file in order, as they are checked.
class Lines {
 public:
  Lines(const store::AuditKey& key, AnchorReport& out) : key_(key), out_(out) {}
  void add(const std::string& line) {
    ++number_;
    const auto anchor = anchor_of(line);
    if (!anchor) return wrong("is not an anchor");
    if (anchor->count == 0 && out_.anchors > 0) wrong("has no MAC");
    if (anchor->count > 0 && anchor->mac != mac_of(key_, kAnchorLabel, *anchor))
      return wrong("was not written with this server's key, or was changed");
    if (anchor->count > 0 && anchor->count != out_.anchors + 1)
      wrong(fmt::format("is anchor {}, anchor {} is missing", anchor->count, out_.anchors + 1));
    out_.anchors = std::max(out_.anchors, anchor->count);
    if (anchor->end.number > 0) out_.ends.push_back(anchor->end);
    out_.newest_utc_us = anchor->at_utc_us;
  }

 private:
  void wrong(const std::string& why) {
    out_.findings.push_back(fmt::format("{}: line {}: {}", kAnchors, number_, why));
  }
  const store::AuditKey& key_;
  AnchorReport& out_;
  int number_ = 0;
};

void check_high_water(const Anchor& high, AnchorReport& out) {
  out.has_high_water = true;
  if (high.end.number > 0) out.ends.push_back(high.end);
  if (out.anchors < high.count)
    out.findings.push_back(
        fmt::format("{}: ends with anchor {}, but {} were made: it was cut, deleted or replaced by "
                    "an older one",
                    kAnchors, out.anchors, high.count));
}

Result<void> check_copy(const fs::path& path, const store::AuditKey& key, AnchorReport& out) {
  std::int64_t newest = 0;
  TRY(each_line(path, [&](const std::string& line) {
    const auto anchor = anchor_of(line);
    if (!anchor || anchor->count == 0 || anchor->mac != mac_of(key, kAnchorLabel, *anchor)) return;
    newest = std::max(newest, anchor->count);
    if (anchor->end.number > 0) out.ends.push_back(anchor->end);
  }));
  if (newest == 0)
    return Error{Errc::bad_input,
                 path.string() + ": has no anchor that was made with this server's key"};
  if (newest > out.anchors)
    out.findings.push_back(fmt::format("{}: ends with anchor {}, but {} has anchor {}", kAnchors,
                                       out.anchors, path.string(), newest));
  return {};
}

}  // namespace

Result<AnchorReport> check_anchors(const fs::path& data, const store::AuditKey& key,
                                   const std::optional<fs::path>& copy) {
  AnchorReport out;
  const auto high = high_water_of(data, key);  // first: the other file is never behind it
  if (!high && high.error().code != Errc::corrupt) return high.error();
  Lines lines(key, out);
  auto read = each_line(data / kAnchors, [&](const std::string& line) { lines.add(line); });
  if (!read && read.error().code != Errc::not_found) return read.error();
  if (!high) out.findings.push_back(high.error().what);
  if (high && *high) check_high_water(**high, out);
  if (copy) TRY(check_copy(*copy, key, out));
  return out;
}

Result<void> begin_anchors_again(DataFolder& data) {
  const std::string when = std::to_string(core::utc_us());
  std::error_code failure;
  fs::rename(data.path / kAnchors, data.path / fmt::format("{}.{}", kAnchors, when), failure);
  auto trail = TRY(trail_state(data.store, 0));
  Anchor anchor{trail.end, 1, core::utc_us()};
  anchor.mac = mac_of(data.store.audit_key(), kAnchorLabel, anchor);
  TRY(append_line(data.path / kAnchors, anchor.line()));
  return write_high_water(data.path, data.store.audit_key(), anchor);
}

Result<void> begin_trail(DataFolder& data) {
  const auto anchored = [&] {
    if (auto noted = note_anchor(data); !noted)
      log_line({{"what", "audit anchor"}, {"error", noted.error().what}});
  };
  anchored();  // before rows are covered: a covered trail without an anchor is a finding
  auto began = TRY(store::begin_coverage(data.store));
  if (!began) return {};
  log_line({{"what", "audit trail"},
            {"covers_rows_of_tables", store::covered_tables().size()},
            {"since", core::utc_text(core::utc_us())}});
  anchored();
  return {};
}

Result<Examined> examine(DataFolder& data, const core::Progress& shown,
                         const std::optional<fs::path>& copy) {
  // Anchors first: what is noted after them is in the database all the more.
  auto anchors = TRY(check_anchors(data.path, data.secrets.audit_key(), copy));
  auto found = TRY(
      store::look_over(data.store, data.objects, data.secrets.audit_key(), anchors.ends, shown));
  found.lines.insert(found.lines.end(), anchors.findings.begin(), anchors.findings.end());
  if (found.covered_since_utc_us > 0 && !anchors.has_high_water)
    found.lines.push_back(
        fmt::format("{}: is missing, so that missing newest rows cannot be detected", kHighWater));
  return Examined{std::move(found), std::move(anchors)};
}

}  // namespace app
}  // namespace tractus
