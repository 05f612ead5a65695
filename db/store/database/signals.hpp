/// Short messages between the processes that share a database, and within one process: for example
/// "a job was queued". A signal is a hint and is not stored: data that must not be lost are in a
/// table, which a subscriber reads.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace tractus::store {

class Writing;

/// A signal as a subscriber receives it.
struct Signal {
  std::string from;     ///< Signals::own_id of the sender, one's own included; empty: see `payload`
  std::string payload;  ///< as it was sent; empty, and `from` too: something may have been missed
                        ///< (the connection broke and is back), look at the tables
};

/// Heard while it lives. Ending it waits until a call under way has returned; not from within one.
class Listening {
 public:
  Listening() = default;
  virtual ~Listening() = default;
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;
};

/// The signals of one Store. On SQLite they stay in this process, on PostgreSQL every process on
/// the same database hears them (NOTIFY). Safe from several threads. One sender's signals on one
/// channel arrive in order, once each.
class Signals {
 public:
  static constexpr std::size_t kMostPayload_bytes =
      7900;  ///< what NOTIFY carries, and our own head
  using Heard = std::function<void(const Signal& signal)>;

  Signals() = default;
  virtual ~Signals() = default;
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// Calls `heard` with every signal of the channel from now on: from one thread for all listeners,
  /// never from within `send`. It must be quick (hand on to a queue of one's own), and may send.
  /// A channel is lower-case letters and underscores, as "jobs". Errors: unavailable.
  virtual core::Result<std::unique_ptr<Listening>> listen(const std::string& channel,
                                                          Heard heard) = 0;
  /// Sends at once, outside of any transaction; for what is no record, as live states. About 0.1 ms
  /// on PostgreSQL, so bundle what comes often. Errors: too_large (over kMostPayload_bytes),
  /// unavailable (the database cannot be reached; nothing was sent).
  /// @pre the payload is not empty, and is text (UTF-8, no zero).
  virtual core::Result<void> send(const std::string& channel, const std::string& payload) = 0;
  /// Which process (rather: which Store) this is.
  virtual const std::string& own_id() const = 0;

  struct Noted {
    std::string channel, payload;
  };

 protected:
  friend class Store;
  /// Store tells what a transaction wants said: in it, before it commits; and once it has.
  virtual core::Result<void> committing(Writing& tx, std::span<const Noted> noted) = 0;
  virtual void committed(std::span<const Noted> noted) = 0;
};

/// Signals within this process, from a thread of their own that starts with the first listener.
std::unique_ptr<Signals> local_signals();

/// Signals between all processes on a PostgreSQL database. Its connections are made when needed.
std::unique_ptr<Signals> postgres_signals(const std::string& address);

/// Sent when, and only when, the transaction commits; the same words twice in one transaction may
/// be heard once. Errors: too_large.
/// @pre as Signals::send
core::Result<void> notify(Writing& tx, const std::string& channel, const std::string& payload);

}  // namespace tractus::store
