/// Samples made durable as they come, in commits of 10 and of 100 ms of a 4 kHz trial: what the
/// station's recorder and the server's uploads reach, against the bare minimum (append and
/// fdatasync of the same bytes) and against rows in PostgreSQL (COPY). Every way is on the disk
/// before the next commit begins; all take turns on the same disk, in rounds, so that who else uses
/// it disturbs all alike; medians of the rounds.
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>

#include "bench/support/report.hpp"
#include "core/bytes.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/people/accounts.hpp"
#include "db/store/trials/uploads.hpp"
#include "db/store/volumes/objects.hpp"
#include "server/api/backend.hpp"
#include "server/api/trials/uploads.hpp"
#include "tests/bench/ingest/postgres_copy.hpp"
#include "tests/support/postgres/postgres_server.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace {
namespace fs = std::filesystem;
using Batch = std::span<const trial::Sample>;

constexpr int kRounds = 7;

trial::Sample sample_at(std::uint32_t tick) {
  trial::Sample s;
  s.t_s = tick * 0.25e-3;
  const double at = s.t_s * 6.28;
  s.p_VH_m = {1e-3 * std::sin(at), 1e-3 * std::cos(at), -0.1 + 1e-3 * std::sin(3 * at)};
  s.force_N = {float(std::sin(7 * at)), float(std::cos(5 * at)), float(std::sin(11 * at))};
  s.tick = tick;
  return s;
}

core::ByteView bytes_of(Batch batch) { return std::as_bytes(batch); }

/// The least that can be done: the bytes at the end of a file, flushed.
class Raw {
 public:
  explicit Raw(const fs::path& path)
      : fd_(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644)) {}
  ~Raw() { ::close(fd_); }
  Raw(const Raw&) = delete;
  Raw& operator=(const Raw&) = delete;
  bool add(Batch batch) const {
    const auto bytes = bytes_of(batch);
    return ::write(fd_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()) &&
           ::fdatasync(fd_) == 0;
  }

 private:
  int fd_;
};

/// The server's way, as its route calls it: who asks is looked up, the checksum is made, the piece
/// is in the partial file and flushed.
class Upload {
 public:
  Upload(const fs::path& folder, store::Store store)
      : store_(std::move(store)),
        objects_(std::move(store::Objects::open(folder).value())),
        partials_(std::move(store::PartialFiles::open(folder).value())),
        id_(core::new_id()) {
    auto made = store_.write([&](store::Writing& tx) -> core::Result<void> {
      if (auto done = store::add_station(tx, {"s", "s"}, "t", 1); !done) return done;
      if (auto done = store::add_case(tx, {"c", "c", "", 1, 0}, {}, 1); !done) return done;
      return store::add_upload(tx, {id_, "s", "c", 1u << 30, "x", store::UploadPhase::receiving},
                               1);
    });
    core::require(bool(made), "the upload is announced");
  }
  bool add(Batch batch) {
    const auto bytes = bytes_of(batch);
    const auto taken =
        api::append_upload(backend_, station_, id_, offset_, core::crc32c(bytes), bytes);
    offset_ += bytes.size();
    return taken && taken->taken;
  }
  fs::path file() const { return partials_.path_of(id_); }

 private:
  store::Store store_;
  store::Objects objects_;
  store::PartialFiles partials_;
  api::Backend backend_{.store = store_,
                        .objects = objects_,
                        .partials = partials_,
                        .now_utc_us = [] { return std::int64_t{1}; },
                        .work_waits = [] {}};
  const api::Caller station_{api::Role::station, "s", "s", ""};
  std::string id_;
  std::uint64_t offset_ = 0;
};

struct Rival {
  const char* name;
  std::function<bool(Batch)> add;
  std::vector<double> rows_per_s = {};
};

/// Rounds in which every rival takes the same batches; returns the samples each has taken.
std::size_t take_turns(std::vector<Rival>& rivals, const std::vector<trial::Sample>& samples,
                       std::size_t rows, int commits, bench::Report& report) {
  std::size_t taken = 0;
  for (int round = 0; round < kRounds; ++round) {
    for (Rival& rival : rivals) {
      bool fine = true;
      const double start = bench::wall_s();
      for (int i = 0; i < commits; ++i)
        fine = fine && rival.add(Batch(samples).subspan(taken + std::size_t(i) * rows, rows));
      rival.rows_per_s.push_back(double(commits) * double(rows) / (bench::wall_s() - start));
      if (!fine) report.must(std::string(rival.name) + ": every commit succeeds", false);
    }
    taken += std::size_t(commits) * rows;
  }
  return taken;
}

trial::Header header() {
  trial::Header out;
  out.id = core::new_id();
  out.case_id = std::string(64, 'c');
  out.station = "bench";
  out.operator_name = "simulated";
  out.simulated = true;
  out.device = "sim-lambda6";
  out.started_utc_us = 1;
  out.rate_Hz = 4000.0;
  out.probe = core::Json::object();
  return out;
}

struct Wanted {
  const char* what;
  std::size_t rows;
  int commits;
  std::array<double, 3> of_raw;  ///< recorder, uploads on SQLite, on PostgreSQL
};

void run(const Wanted& wanted, const fs::path& folder, test_support::PostgresServer& postgres,
         bench::Report& report) {
  std::vector<trial::Sample> samples;
  const auto count = static_cast<std::uint32_t>(wanted.rows) *
                     static_cast<std::uint32_t>(wanted.commits * kRounds);
  for (std::uint32_t tick = 0; tick < count; ++tick) samples.push_back(sample_at(tick));
  const Raw raw(folder / "raw");
  auto writer = trial::TrialWriter::create(folder / "t.trial", header());
  core::require(bool(writer), "a trial file can be made");
  Upload on_sqlite(folder, std::move(store::Store::open(folder / "tractus.db").value()));
  const std::string address = postgres.address(postgres.add_database());
  Upload on_postgres(folder, std::move(store::Store::open_postgres(address).value()));
  bench::PostgresCopy copy(postgres.address(postgres.add_database()));
  std::vector<Rival> rivals{
      {"raw append + fdatasync", [&](Batch b) { return raw.add(b); }},
      {"station's recorder", [&](Batch b) { return writer->append(b) && writer->flush(); }},
      {"server's upload, SQLite", [&](Batch b) { return on_sqlite.add(b); }},
      {"server's upload, PostgreSQL", [&](Batch b) { return on_postgres.add(b); }},
      {"PostgreSQL COPY of rows", [&](Batch b) { return copy.add(b); }}};
  const std::size_t taken = take_turns(rivals, samples, wanted.rows, wanted.commits, report);
  const std::string expected = core::sha256(bytes_of(Batch(samples).first(taken)));
  for (const fs::path& file : {folder / "raw", on_sqlite.file(), on_postgres.file()})
    report.must(file.filename().string() + " holds the samples",
                store::file_sha256(file).value() == expected);
  report.must("the table holds as many rows", copy.rows() == static_cast<long>(taken));
  std::vector<double> medians;
  for (Rival& rival : rivals) {
    medians.push_back(bench::quantile(rival.rows_per_s, 0.5));
    report.row(std::string(rival.name) + ", " + wanted.what, medians.back(), "samples/s");
  }
  for (std::size_t i = 1; i < 4; ++i)
    report.at_least(std::string(rivals[i].name) + " of raw, " + wanted.what,
                    medians[i] / medians[0], wanted.of_raw[i - 1], "");
  // Where one flush a commit is nearly all there is to do, nobody is twice as fast as another.
  const bool flush_bound = medians[0] < 2.0 * medians[4];
  for (std::size_t i = 1; i < 4; ++i) {
    const std::string words = std::string(rivals[i].name) + " of COPY, " + wanted.what;
    if (flush_bound)
      report.row(words, medians[i] / medians[4], "", "raw is less than twice COPY");
    else
      report.at_least(words, medians[i] / medians[4], 2.0, "");
  }
}

}  // namespace

}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  bench::Report report("ingest: samples of 136 bytes, each commit on the disk");
  const fs::path folder = fs::temp_directory_path() / ("tractus-ingest-" + core::new_id());
  test_support::PostgresServer postgres(test_support::Durable::yes);
  for (const Wanted& wanted : {Wanted{"10 ms commits", 40, 60, {0.9, 0.8, 0.6}},
                               Wanted{"100 ms commits", 400, 40, {0.9, 0.9, 0.8}}}) {
    fs::create_directories(folder);
    run(wanted, folder, postgres, report);
    fs::remove_all(folder);
  }
  return report.finish(argc, argv);
}
