/// TRY: the value of a Result, or its error handed to the caller (ADR-0031).
#pragma once

#include <type_traits>
#include <utility>

#include "core/result.hpp"

namespace tractus::core {

/// The value of a Result that holds one; for Result<void> nothing.
template <class T>
[[nodiscard]] T value_of(Result<T>&& result) {
  if constexpr (!std::is_void_v<T>) return std::move(result).value();
}

}  // namespace tractus::core

#define TRACTUS_JOIN_(a, b) a##b
#define TRACTUS_TRY_(result, ...)                 \
  ({                                              \
    auto result = (__VA_ARGS__);                  \
    if (!result) return result.error();           \
    ::tractus::core::value_of(std::move(result)); \
  })
#define TRACTUS_TRY_COUNTED_(count, ...) \
  TRACTUS_TRY_(TRACTUS_JOIN_(tractus_result_, count), __VA_ARGS__)

/// `const auto volume = TRY(read_volume(path));` returns the error from the enclosing function when
/// there is one, or gives the value. The function returns a Result or an Error. Not for coroutines,
/// which `co_return`. A statement expression, as gcc and clang have it.
#define TRY(...) TRACTUS_TRY_COUNTED_(__COUNTER__, __VA_ARGS__)
