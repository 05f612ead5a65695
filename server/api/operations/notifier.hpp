/// Sends what the outbox holds (db/store/operations/deliveries.hpp), off the threads of requests.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "db/store/operations/deliveries.hpp"
#include "server/api/backend.hpp"
#include "server/api/learning/score_call.hpp"
#include "server/api/learning/statement.hpp"
#include "server/api/operations/mail.hpp"
#include "server/api/operations/webhook_call.hpp"

namespace tractus::api {

struct NotifierSettings {
  std::optional<MailSettings> mail = {};  ///< none: no e-mail is sent
  http::Networks networks = {};           ///< private networks that are called
  std::string base = {};                  ///< "https://host:8480", for addresses of pages
  std::function<core::Result<void>(const MailSettings&, const Mail&)> send = send_mail;
  std::function<core::Result<void>(const WebhookCall&)> call = call_webhook;
  std::function<core::Result<void>(const ScoreCall&)> score = post_score;
  std::function<core::Result<void>(const StatementCall&)> state = post_statement;
};

class Notifier {
 public:
  Notifier(Backend& backend, NotifierSettings settings);
  ~Notifier();
  Notifier(const Notifier&) = delete;
  Notifier& operator=(const Notifier&) = delete;

  /// Starts a thread for each channel, so that a slow receiver of one does not delay the other.
  void start();
  /// Something happened: look now.
  void wake();
  const NotifierSettings& settings() const { return settings_; }

  /// Notes due assignments and queues the deliveries of new events, scores and statements.
  core::Result<void> collect();
  /// Sends what is due on a channel; returns the number of attempts.
  core::Result<std::size_t> deliver(store::Channel channel);

 private:
  core::Result<void> attempt(const store::Delivery& delivery);
  core::Result<void> attempt_mail(const store::Delivery& delivery);
  core::Result<void> attempt_call(const store::Delivery& delivery);
  core::Result<void> attempt_score(const store::Delivery& delivery);
  core::Result<void> attempt_statement(const store::Delivery& delivery);
  core::Result<void> note_outcome(const store::Delivery& delivery,
                                  const core::Result<void>& outcome);
  core::Result<void> give_up(const store::Delivery& delivery, const std::string& why);
  void run(store::Channel channel);
  /// Looks for relapses when trials have come since, at most every kRelapsesEvery_us.
  core::Result<void> look_for_relapses(std::int64_t now_utc_us);
  core::Result<void> look_for_learning(std::int64_t now_utc_us);
  void log(const core::Json& fields) const;

  Backend& backend_;
  NotifierSettings settings_;
  std::mutex mutex_;  ///< guards ending_ and woken_
  std::condition_variable changed_;
  bool ending_ = false;
  std::uint64_t woken_ = 0;
  std::mutex relapses_mutex_;  ///< guards the two below
  std::int64_t relapses_at_utc_us_ = 0, trials_then_ = -1;
  std::vector<std::thread> threads_;
};

}  // namespace tractus::api
