/// Errors as values: what the world (files, devices, network, input) may do to us comes back as a
/// Result.
#pragma once

#include <string>
#include <utility>
#include <variant>

#include "core/require.hpp"

namespace tractus::core {

/// The system's one list of causes. The server maps each to an HTTP status (server/api).
enum class Errc {
  bad_input,     ///< a file, a field or an argument is not what was asked for
  out_of_range,  ///< a number outside its allowed range
  not_found,     ///< nothing by that name
  corrupt,       ///< a checksum or a structure of ours does not hold
  io,            ///< the operating system refused
  conflict,      ///< it contradicts what is already there
  unauthorised,  ///< who are you?
  forbidden,     ///< known, and not allowed
  too_large,     ///< over a stated limit
  unavailable,   ///< a device or a peer does not answer; trying later may help
  cancelled,     ///< a person stopped it
};

/// `what` is one line for a person: file or field, what is wrong (with values), what is expected.
struct Error {
  Errc code;
  std::string what;
};

inline Error bad_input(std::string what) { return {Errc::bad_input, std::move(what)}; }

/// A value of T or an Error. Ignoring one does not compile.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : held_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : held_(std::in_place_index<1>, std::move(error)) {}

  explicit operator bool() const noexcept { return held_.index() == 0; }
  /// Our bug if there is none: check first.
  T& value() & {
    return require(bool(*this), "a Result was read without a check"), std::get<0>(held_);
  }
  const T& value() const& {
    return require(bool(*this), "a Result was read without a check"), std::get<0>(held_);
  }
  T&& value() && {
    return require(bool(*this), "a Result was read without a check"), std::get<0>(std::move(held_));
  }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const Error& error() const {
    return require(!*this, "a Result without error was asked for one"), std::get<1>(held_);
  }

 private:
  std::variant<T, Error> held_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)), ok_(false) {}
  explicit operator bool() const noexcept { return ok_; }
  const Error& error() const {
    return require(!ok_, "a Result without error was asked for one"), error_;
  }

 private:
  Error error_{};
  bool ok_ = true;
};

}  // namespace tractus::core
