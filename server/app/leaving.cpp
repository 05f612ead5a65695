#include "server/app/leaving.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "core/bytes.hpp"
#include "core/clock.hpp"
#include "core/json.hpp"
#include "core/try.hpp"
#include "db/store/people/retention.hpp"
#include "server/app/log.hpp"

namespace tractus {
namespace app {
namespace fs = std::filesystem;
namespace {

using core::Json;
using core::Result;

constexpr const char* kListFormat = "tractus-erasures/1";
constexpr std::chrono::minutes kBetweenPasses{10};
constexpr long kMostErasures = 1'000'000'000;

Result<store::Erasure> erasure_from(const Json& json, const std::string& where) {
  core::Fields fields(json, where);
  store::Erasure out{.number = fields.integer("number", 1, kMostErasures),
                     .account_id = fields.text("account_id", 64),
                     .mode = fields.word<store::ErasureMode>("mode"),
                     .cause = store::ErasureCause::restored};
  TRY(fields.done());
  return out;
}

/// Nothing for a person who is not in these records, or erased in them already.
Result<bool> apply_one(DataFolder& data, const store::Erasure& erasure) {
  const store::AuditScope scope(command_act("restore", {{"erasure", erasure.number}}));
  return data.store.write([&](store::Writing& tx) -> Result<bool> {
    auto wish = erasure;
    wish.begun_utc_us = core::utc_us();
    const auto known = TRY(tx.query("select 1 from accounts where id = ?", {erasure.account_id}));
    if (known.empty() || TRY(store::is_erased(tx, erasure.account_id))) return false;
    TRY(store::begin_erasure(tx, wish));
    return true;
  });
}

}  // namespace

Result<std::vector<store::Erasure>> read_erasure_list(const fs::path& file) {
  const Json json = TRY(core::read_json(file));
  core::Fields fields(json, file.string());
  if (fields.text("format", 64) != kListFormat)
    fields.wrong("format", std::string(kListFormat) + " is expected");
  const Json* list = fields.member("erasures");
  if (list && !list->is_array()) fields.wrong("erasures", "an array is expected");
  TRY(fields.done());
  std::vector<store::Erasure> out;
  for (const Json& one : *list)
    out.push_back(
        TRY(erasure_from(one, fmt::format("{}: /erasures/{}", file.string(), out.size()))));
  return out;
}

Result<void> write_erasure_list(store::Store& store, const fs::path& file) {
  const auto all = TRY(store.read([](store::Reading& tx) { return store::all_erasures(tx); }));
  Json list = Json::array();
  for (const store::Erasure& one : all)
    list.push_back(
        {{"number", one.number}, {"account_id", one.account_id}, {"mode", core::name(one.mode)}});
  std::error_code failure;
  fs::create_directories(file.parent_path(), failure);
  return core::write_json(file, {{"format", kListFormat}, {"erasures", list}});
}

Result<void> finish_erasures(DataFolder& data, const std::vector<fs::path>& lists) {
  const auto begun =
      TRY(data.store.read([](store::Reading& tx) { return store::unfinished_erasures(tx); }));
  if (begun.empty()) return {};
  for (const fs::path& list : lists) TRY(write_erasure_list(data.store, list));
  for (const std::int64_t number : begun)
    TRY(store::finish_erasure(data.store, data.objects, data.partials, number, core::utc_us()));
  return {};
}

Result<std::size_t> apply_erasures(DataFolder& data, const std::vector<store::Erasure>& list) {
  std::size_t applied = 0;
  for (const store::Erasure& erasure : list)
    if (TRY(apply_one(data, erasure))) ++applied;
  TRY(finish_erasures(data, {data.path / kErasureList}));
  return applied;
}

Leaving::Leaving(DataFolder& data, std::vector<fs::path> lists, std::function<void()> forget)
    : data_(data),
      lists_(std::move(lists)),
      forget_(std::move(forget)),
      thread_([this] { run(); }) {}

Leaving::~Leaving() {
  {
    const std::lock_guard held(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Leaving::wake() {
  {
    const std::lock_guard held(mutex_);
    woken_ = true;
  }
  changed_.notify_all();
}

void Leaving::run() {
  std::unique_lock held(mutex_);
  while (!ending_) {
    woken_ = false;
    held.unlock();
    if (const auto done = pass(); !done)
      log_line({{"what", "erasures and retention"}, {"error", done.error().what}});
    held.lock();
    changed_.wait_for(held, kBetweenPasses, [this] { return ending_ || woken_; });
  }
}

Result<void> Leaving::pass() {
  forget_if_somebody_left();
  TRY(finish_erasures(data_, lists_));
  const auto begun = TRY(store::keep_retention(data_.store, core::utc_us()));
  forget_if_somebody_left();
  if (!begun.empty()) TRY(finish_erasures(data_, lists_));
  return {};
}

void Leaving::forget_if_somebody_left() {
  const auto all = data_.store.read([](store::Reading& tx) { return store::all_erasures(tx); });
  if (all && erasures_ == all->size()) return;
  if (all) erasures_ = all->size();
  forget_();
}

}  // namespace app
}  // namespace tractus
