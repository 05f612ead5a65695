/// Who listens on which channel; what both kinds of Signals are made of.
#pragma once

#include <list>
#include <mutex>

#include "db/store/database/signals.hpp"

namespace tractus::store {

/// Errors: too_large. @pre not empty
core::Result<void> check_payload(const std::string& payload);

/// Safe from several threads. What `add` hands out may outlive it.
class Listeners {
 public:
  Listeners() : table_(std::make_shared<Table>()) {}

  std::unique_ptr<Listening> add(const std::string& channel, Signals::Heard heard) {
    auto entry = std::make_shared<Entry>();
    entry->channel = channel;
    entry->heard = std::move(heard);
    const std::lock_guard held(table_->mutex);
    table_->entries.push_back(entry);
    return std::make_unique<One>(table_, entry);
  }

  /// Calls everybody on `channel`, one after the other; with an empty channel, everybody.
  void tell(const std::string& channel, const Signal& signal) {
    std::vector<std::shared_ptr<Entry>> now;
    {
      const std::lock_guard held(table_->mutex);
      for (const auto& entry : table_->entries)
        if (channel.empty() || entry->channel == channel) now.push_back(entry);
    }
    for (const auto& entry : now) {
      const std::lock_guard calling(entry->calling);
      if (entry->heard) entry->heard(signal);
    }
  }

 private:
  struct Entry {
    std::string channel;
    std::mutex calling;  ///< held during a call, and to end the listening
    Signals::Heard heard;
  };
  struct Table {
    std::mutex mutex;  ///< guards entries
    std::list<std::shared_ptr<Entry>> entries;
  };
  class One final : public Listening {
   public:
    One(std::shared_ptr<Table> table, std::shared_ptr<Entry> entry)
        : table_(std::move(table)), entry_(std::move(entry)) {}
    ~One() override {
      {
        const std::lock_guard held(table_->mutex);
        table_->entries.remove(entry_);
      }
      const std::lock_guard calling(entry_->calling);
      entry_->heard = nullptr;
    }

   private:
    std::shared_ptr<Table> table_;
    std::shared_ptr<Entry> entry_;
  };
  std::shared_ptr<Table> table_;
};

}  // namespace tractus::store
