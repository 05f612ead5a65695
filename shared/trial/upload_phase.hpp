/// How far a trial's file has come to the server: one word for the messages and the database.
#pragma once

#include "core/named.hpp"

namespace tractus::trial {

enum class UploadPhase {
  receiving,
  complete,  ///< every byte is there, checked and committed
};
constexpr auto words(UploadPhase) {
  return std::to_array<core::Word<UploadPhase>>(
      {{UploadPhase::receiving, "receiving"}, {UploadPhase::complete, "complete"}});
}
using core::name;

}  // namespace tractus::trial
