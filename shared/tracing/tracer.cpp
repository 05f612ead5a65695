#include "tracing/tracer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/bytes.hpp"

namespace tractus {
namespace tracing {

using namespace std::chrono_literals;

Tracer::Tracer(Settings settings, Post post, Log log)
    : settings_(std::move(settings)), post_(std::move(post)), log_(std::move(log)) {
  thread_ = std::thread([this] { run(); });
}

Tracer::~Tracer() {
  {
    const std::lock_guard held(mutex_);
    ending_ = Clock::now() + kLastTry;
  }
  changed_.notify_all();
  thread_.join();
}

void Tracer::record(SpanRecord span) {
  {
    const std::lock_guard held(mutex_);
    if (waiting_.size() >= kMostWaiting) {
      ++counts_.dropped;
      return;
    }
    waiting_.push_back(std::move(span));
  }
  changed_.notify_one();
}

Tracer::Counts Tracer::counts() const {
  const std::lock_guard held(mutex_);
  return counts_;
}

bool Tracer::is_over() const {
  const std::lock_guard held(mutex_);
  return ending_ && Clock::now() >= *ending_;
}

/// Empty once there is nothing to send and never will be.
std::vector<SpanRecord> Tracer::next_batch() {
  std::unique_lock held(mutex_);
  changed_.wait(held, [this] { return ending_ || !waiting_.empty(); });
  changed_.wait_for(held, settings_.delay,
                    [this] { return ending_ || waiting_.size() >= kMostSent; });
  std::vector<SpanRecord> out;
  while (!waiting_.empty() && out.size() < kMostSent) {
    out.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
  }
  return out;
}

void Tracer::wait_before_next_try() {
  const auto wait = std::min(settings_.delay * (1 << std::min(tries_, 10)), kLongestWait);
  std::unique_lock held(mutex_);
  changed_.wait_for(held, wait, [this] { return ending_.has_value(); });
}

bool Tracer::deliver(const std::vector<SpanRecord>& batch, const std::string& body) {
  auto most = settings_.timeout;
  bool last = false;
  {
    const std::lock_guard held(mutex_);
    last = ending_.has_value();
    if (last)
      most = std::clamp(std::chrono::ceil<std::chrono::milliseconds>(*ending_ - Clock::now()), 1ms,
                        most);
  }
  const Delivered done = post_(body, most, [this] { return is_over(); });
  if (told_ != done.why) log_(told_ = done.why);
  if (done.delivery == Delivery::away && !last) return false;
  const std::uint64_t dropped = done.delivery == Delivery::taken
                                    ? std::min<std::uint64_t>(done.rejected, batch.size())
                                    : batch.size();
  const std::lock_guard held(mutex_);
  counts_.dropped += dropped;
  counts_.sent += batch.size() - dropped;
  return true;
}

void Tracer::run() {
  for (auto batch = next_batch(); !batch.empty(); batch = next_batch()) {
    const std::string body = otlp_json(settings_.resource, batch);
    for (tries_ = 0; !deliver(batch, body); ++tries_) wait_before_next_try();
  }
}

std::unique_ptr<Tracer> tracer_of_environment(const std::string& service_name,
                                              const std::string& version, Tracer::Log log) {
  auto settings = read_settings(process_environment(), service_name);
  if (!settings) log(settings.error().what);
  if (!settings || !*settings) return nullptr;
  auto& resource = (*settings)->resource;
  resource.emplace_back("service.version", version);
  resource.emplace_back("service.instance.id", core::new_id());  // of this process
  Post post = http_post(**settings);
  return std::make_unique<Tracer>(std::move(**settings), std::move(post), std::move(log));
}

Span::Span(Tracer* tracer, std::string name, SpanKind kind,
           const std::optional<SpanContext>& parent) {
  if (!tracer || (parent && !parent->sampled)) return;
  tracer_ = tracer;
  context_ = SpanContext{parent ? parent->trace_id : core::new_id(), core::new_id().substr(16)};
  begun_ = std::chrono::steady_clock::now();
  record_.context = *context_;
  record_.parent_id = parent ? parent->span_id : "";
  record_.name = std::move(name);
  record_.kind = kind;
  record_.begun_utc_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                             std::chrono::system_clock::now().time_since_epoch())
                             .count();
}

Span::~Span() {
  if (!tracer_) return;
  const std::chrono::nanoseconds took = std::chrono::steady_clock::now() - begun_;
  record_.ended_utc_ns = record_.begun_utc_ns + took.count();
  tracer_->record(std::move(record_));
}

void Span::set(const std::string& key, core::Json value) {
  if (tracer_) record_.attributes[key] = std::move(value);
}

void Span::set_failed(const std::string& type) {
  if (!tracer_) return;
  record_.failed = !type.empty();
  if (record_.failed)
    record_.attributes["error.type"] = type;
  else
    record_.attributes.erase("error.type");
}

std::string Span::traceparent() const { return context_ ? tracing::traceparent(*context_) : ""; }

}  // namespace tracing
}  // namespace tractus
