/// Every trial that waits, several at a time.
#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "core/errc_words.hpp"
#include "core/try.hpp"
#include "station/uplink/upload.hpp"

namespace tractus {
namespace uplink {
namespace fs = std::filesystem;
namespace {

bool later_helps(core::Errc code) {  // worth trying again later
  return code == core::Errc::unavailable || code == core::Errc::cancelled ||
         code == core::Errc::io || code == core::Errc::too_large;
}

/// A trial's upload as a trace: a span for all its tries, and one for each request, which says to
/// the server whose child its own is.
class TracedServer final : public Server {
 public:
  TracedServer(tracing::Tracer* tracer, const OutboxEntry& entry)
      : tracer_(tracer),
        trial_id_(entry.trial_id),
        span_(tracer, "upload trial", tracing::SpanKind::internal, std::nullopt) {
    span_.set("tractus.trial.size_bytes", entry.size_bytes);
  }
  /// The connection of the next try.
  TracedServer& over(Server& server) { return server_ = &server, *this; }
  core::Result<HttpResponse> send(const Request& request) override {
    if (!tracer_) return server_->send(request);
    tracing::Span span(tracer_, request.method + " " + pattern_of(request.path),
                       tracing::SpanKind::client, span_.context());
    Request sent = request;
    sent.headers.emplace_back("traceparent", span.traceparent());
    auto answer = server_->send(sent);
    span.set("http.request.method", request.method);
    span.set("http.request.body.size", request.body.size());
    if (answer) span.set("http.response.status_code", answer->status);
    if (!answer) span.set_failed(std::string(core::name(answer.error().code)));
    if (answer && answer->status >= 400) span.set_failed(std::to_string(answer->status));
    return answer;
  }
  void note(const core::Result<void>& outcome) {
    span_.set_failed(outcome ? "" : std::string(core::name(outcome.error().code)));
  }

 private:
  /// Without the trial's id and the query.
  std::string pattern_of(const std::string& path) const {
    std::string out = path.substr(0, path.find('?'));
    if (const auto at = out.find(trial_id_); at != std::string::npos)
      out.replace(at, trial_id_.size(), "{trial_id}");
    return out;
  }

  Server* server_ = nullptr;
  tracing::Tracer* tracer_;
  const std::string trial_id_;
  tracing::Span span_;
};

/// A trial that waits, and what became of it.
struct Waiting {
  OutboxEntry entry = {};
  std::optional<TracedServer> traced = std::nullopt;  ///< for all its tries
  bool ended = false;                                 ///< handed over, or refused
};

/// One try of everything that waits. Connections take the trials in order and send their pieces
/// side by side; a trial is committed once every older one has ended. The first that the server
/// does not take now ends the try: none is begun or committed after it.
class Attempt {
 public:
  Attempt(const Outbox& outbox, const fs::path& trials_folder, const core::Progress& progress,
          const std::optional<ClockOffset>& offset, tracing::Tracer* tracer,
          std::deque<Waiting>& trials)
      : outbox_(outbox),
        trials_folder_(trials_folder),
        progress_(progress),
        offset_(offset),
        tracer_(tracer),
        trials_(trials) {
    pass_turn();
  }

  void run(const std::vector<Server*>& connections) {
    std::vector<std::jthread> others;
    const std::size_t used = std::min(connections.size(), trials_.size());
    for (std::size_t i = 1; i < used; ++i)
      others.emplace_back([this, server = connections[i]] { work(*server); });
    work(*connections.front());
  }

  bool went_on() const { return went_on_; }  ///< something more is acknowledged
  const std::optional<core::Error>& failure() const { return failure_; }
  /// The outbox could not be written.
  const std::optional<core::Error>& unwritten() const { return unwritten_; }

 private:
  std::optional<std::size_t> take() {
    const std::lock_guard held(mutex_);
    while (!failure_ && next_ < trials_.size() && trials_[next_].ended) ++next_;
    if (failure_ || next_ == trials_.size()) return std::nullopt;
    return next_++;
  }

  void work(Server& server) {
    while (const auto place = take()) {
      Waiting& trial = trials_[*place];
      if (!trial.traced) trial.traced.emplace(tracer_, trial.entry);
      const std::uint64_t before = trial.entry.offset_bytes;
      const auto outcome = upload_trial(
          trial.traced->over(server), trials_folder_ / (trial.entry.trial_id + ".ttrial"),
          trial.entry, progress(), offset_, [&] { return wait_for_turn(*place); });
      trial.traced->note(outcome);
      note(*place, outcome, before);
      if (trial.entry.state != OutboxState::queued) trial.traced.reset();  // its trace ends here
    }
  }

  core::Progress progress() {
    if (!progress_) return {};
    return [this](double share) {
      const std::lock_guard held(progressing_);
      return progress_(share);
    };
  }

  /// False: an older one waits for the server, and so must this one.
  bool wait_for_turn(std::size_t place) {
    std::unique_lock held(mutex_);
    changed_.wait(held, [&] { return turn_ == place || (failure_ && failed_ < place); });
    return turn_ == place;
  }

  void pass_turn() {
    while (turn_ < trials_.size() && trials_[turn_].ended) ++turn_;
  }

  void note(std::size_t place, const core::Result<void>& outcome, std::uint64_t before) {
    Waiting& trial = trials_[place];
    const bool waits = !outcome && (outcome.error().code == core::Errc::unauthorised ||
                                    later_helps(outcome.error().code));
    if (!outcome && !waits)
      trial.entry.state = OutboxState::refused, trial.entry.reason = outcome.error().what;
    {
      const std::lock_guard held(mutex_);
      went_on_ = went_on_ || !waits || trial.entry.offset_bytes > before;
      trial.ended = !waits;
      pass_turn();
      if (waits) fail(place, outcome.error());
    }
    changed_.notify_all();
    if (auto written = outbox_.write(trial.entry); !written) {
      const std::lock_guard held(mutex_);
      unwritten_ = written.error();
      fail(place, written.error());
    }
  }

  /// What the oldest met is why the others wait.
  void fail(std::size_t place, const core::Error& why) {
    if (!failure_ || place < failed_) failure_ = why, failed_ = place;
  }

  const Outbox& outbox_;
  const fs::path& trials_folder_;
  const core::Progress& progress_;
  const std::optional<ClockOffset>& offset_;
  tracing::Tracer* tracer_;
  std::deque<Waiting>& trials_;
  std::mutex progressing_;
  std::mutex mutex_;  ///< guards what follows, and Waiting::ended
  std::condition_variable changed_;
  std::size_t next_ = 0, turn_ = 0, failed_ = 0;
  bool went_on_ = false;
  std::optional<core::Error> failure_, unwritten_;
};

}  // namespace

core::Json UploadReport::to_json() const {
  return {{"handed_over", handed_over}, {"refused", refused}, {"waiting", waiting}, {"why", why}};
}

core::Result<UploadReport> upload_all(const std::vector<Server*>& connections, const Outbox& outbox,
                                      const fs::path& trials_folder, core::Clock& clock,
                                      const Patience& patience, const core::Progress& progress,
                                      const std::optional<ClockOffset>& offset,
                                      tracing::Tracer* tracer) {
  auto entries = TRY(outbox.entries());
  std::deque<Waiting> trials;
  for (OutboxEntry& entry : entries)
    if (entry.state == OutboxState::queued) trials.emplace_back().entry = std::move(entry);
  UploadReport report;
  core::Instant_ns wait = patience.first_wait_ns, last_progress = clock.now();
  for (;;) {
    Attempt attempt(outbox, trials_folder, progress, offset, tracer, trials);
    attempt.run(connections);
    if (attempt.unwritten()) return *attempt.unwritten();
    const auto& failure = attempt.failure();
    if (!failure) break;
    if (failure->code == core::Errc::unauthorised) return *failure;
    report.why = failure->what;
    if (attempt.went_on()) last_progress = clock.now(), wait = patience.first_wait_ns;
    if (failure->code == core::Errc::cancelled ||
        clock.now() - last_progress >= patience.give_up_after_ns)
      break;
    clock.sleep_until(clock.now() + wait);
    wait = std::min(2 * wait, patience.longest_wait_ns);
  }
  for (const Waiting& trial : trials)
    ++(!trial.ended                                ? report.waiting
       : trial.entry.state == OutboxState::refused ? report.refused
                                                   : report.handed_over);
  if (report.waiting == 0) report.why.clear();
  return report;
}

}  // namespace uplink
}  // namespace tractus
