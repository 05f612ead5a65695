/// The words of the causes of errors, as answers of the server write them.
#pragma once

#include "core/named.hpp"
#include "core/result.hpp"

namespace tractus::core {

constexpr auto words(Errc) {
  using enum Errc;
  return std::to_array<Word<Errc>>({{bad_input, "bad_input"},
                                    {out_of_range, "out_of_range"},
                                    {not_found, "not_found"},
                                    {corrupt, "corrupt"},
                                    {io, "io"},
                                    {conflict, "conflict"},
                                    {unauthorised, "unauthorised"},
                                    {forbidden, "forbidden"},
                                    {too_large, "too_large"},
                                    {unavailable, "unavailable"},
                                    {cancelled, "cancelled"}});
}

}  // namespace tractus::core
