#include "station/uplink/part_fetch.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "core/file.hpp"
#include "core/try.hpp"
#include "station/uplink/outbox.hpp"

namespace tractus {
namespace uplink {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kFetched_bytes = 4u << 20;

/// A file that grows; what is written stays through a kill of the process.
class Growing {
 public:
  explicit Growing(const fs::path& path)
      : path_(path), fd_(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644)) {}
  ~Growing() {
    if (fd_ >= 0) ::close(fd_);
  }
  Growing(const Growing&) = delete;
  Growing& operator=(const Growing&) = delete;
  bool open() const { return fd_ >= 0; }
  core::Result<void> add(core::ByteView bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return core::system_error(path_, "cannot write");
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return {};
  }
  core::Result<void> to_disk() {
    if (::fsync(fd_) != 0) return core::system_error(path_, "cannot flush");
    return {};
  }

 private:
  const fs::path& path_;
  int fd_;
};

/// One part on its way.
struct Fetching {
  Server& server;
  const std::string& case_id;
  const cases::Part& part;
  const LocalParts& local;
  const fs::path& target;
  std::uint64_t& fetched_bytes;

  core::Result<core::Bytes> range(std::uint64_t at, std::uint64_t size) const;
  core::Result<std::vector<Segment>> plan() const;
  core::Result<void> resume(const std::vector<Segment>& plan) const;
  core::Result<bool> holds() const;
};

core::Result<core::Bytes> Fetching::range(std::uint64_t at, std::uint64_t size) const {
  const Request request{.method = "GET",
                        .path = fmt::format("/api/v1/cases/{}/parts/{}", case_id, part.name),
                        .headers = {{"Range", fmt::format("bytes={}-{}", at, at + size - 1)}},
                        .max_answer_bytes = size};
  auto answer = TRY(server.send(request));
  if (answer.status != 206 && !(answer.status == 200 && size == part.size_bytes))
    return answer.status / 100 == 2
               ? case_changed(case_id, part.name + ": the server ignores ranges")
               : error_of(request, answer);
  if (answer.body.size() != size)
    return case_changed(case_id, part.name + ": a piece has the wrong size");
  fetched_bytes += size;
  return std::move(answer.body);
}

/// Of a stored volume the index is looked at first.
core::Result<std::vector<Segment>> Fetching::plan() const {
  if (const auto same = local.whole(part.sha256))
    return std::vector<Segment>{{.offset = 0, .size = part.size_bytes, .from = *same}};
  const bool is_volume = part.name.ends_with(".tvol") && !local.empty();
  core::Bytes head;
  for (std::uint64_t known = kVolumeHead_bytes; is_volume && known <= part.size_bytes;) {
    auto more = TRY(range(head.size(), known - head.size()));
    head.insert(head.end(), more.begin(), more.end());
    const auto end = index_end(head);
    if (!end || *end <= known) break;
    known = *end;
  }
  return local.plan(head, part.size_bytes);
}

core::Result<core::Bytes> bytes_here(const Segment& segment, std::uint64_t skipped,
                                     std::uint64_t size) {
  core::Bytes out(size);
  std::ifstream file(segment.from, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(segment.from_offset + skipped));
  file.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::uint64_t>(file.gcount()) == size) return out;
  return core::system_error(segment.from, "cannot read");
}

core::Result<void> Fetching::resume(const std::vector<Segment>& plan) const {
  std::error_code ignored;
  std::uint64_t done = fs::exists(target, ignored) ? fs::file_size(target, ignored) : 0;
  Growing file(target);
  if (!file.open()) return core::system_error(target, "cannot open");
  for (const Segment& segment : plan) {
    while (done < segment.offset + segment.size) {
      const std::uint64_t skipped = done - segment.offset;
      const std::uint64_t size = std::min(kFetched_bytes, segment.size - skipped);
      auto piece =
          TRY(segment.from.empty() ? range(done, size) : bytes_here(segment, skipped, size));
      TRY(file.add(piece));
      done += size;
    }
  }
  return file.to_disk();
}

core::Result<bool> Fetching::holds() const {
  auto digest = TRY(digest_of(target));
  return digest.size_bytes == part.size_bytes && digest.sha256 == part.sha256;
}

}  // namespace

core::Error case_changed(const std::string& case_id, const std::string& what) {
  return {core::Errc::corrupt, fmt::format("case {}: {}", case_id.substr(0, 12), what)};
}

core::Result<void> fetch_part(Server& server, const std::string& case_id, const cases::Part& part,
                              const LocalParts& local, const fs::path& target,
                              std::uint64_t& fetched_bytes) {
  const Fetching fetching{server, case_id, part, local, target, fetched_bytes};
  std::error_code ignored;
  const bool begun = fs::exists(target, ignored);
  if (begun && fs::file_size(target, ignored) == part.size_bytes)
    if (auto whole = fetching.holds(); whole && *whole) return {};
  if (begun && fs::file_size(target, ignored) >= part.size_bytes) fs::remove(target, ignored);
  auto plan = TRY(fetching.plan());
  const bool from_here =
      begun || std::ranges::any_of(plan, [](const Segment& one) { return !one.from.empty(); });
  TRY(fetching.resume(plan));
  auto whole = fetching.holds();
  if (!whole) return whole.error();
  if (*whole) return {};
  fs::remove(target, ignored);
  if (!from_here) return case_changed(case_id, part.name + ": is not what the manifest names");
  TRY(fetching.resume({{.offset = 0, .size = part.size_bytes}}));
  whole = fetching.holds();
  if (!whole) return whole.error();
  if (*whole) return {};
  fs::remove(target, ignored);
  return case_changed(case_id, part.name + ": is not what the manifest names");
}

}  // namespace uplink
}  // namespace tractus
