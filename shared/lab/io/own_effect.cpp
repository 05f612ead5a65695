#include "lab/io/own_effect.hpp"

#include <fmt/format.h>

#include "core/try.hpp"
#include "effects/palpation_expression.hpp"

namespace tractus {
namespace lab_io {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr std::uintmax_t kMost_bytes = 64 << 10;

}  // namespace

Result<OwnEffect> read_own(const std::filesystem::path& path) {
  std::error_code failure;
  const auto size = std::filesystem::file_size(path, failure);
  if (!failure && size > kMost_bytes)
    return Error{Errc::too_large,
                 fmt::format("{}: {} bytes; an effect of one's own takes {} at most", path.string(),
                             size, kMost_bytes)};
  auto json = TRY(core::read_json(path));
  return OwnEffect{std::move(json), path.string() + ": "};
}

Result<std::vector<std::string>> ids_of(const std::vector<OwnEffect>& own, const std::string& rig) {
  std::vector<std::string> out;
  for (const OwnEffect& one : own) {
    const auto expression = TRY(effects::Expression::from_json(
        one.definition, one.where,
        rig == "probing" ? effects::probing_expressions() : effects::palpation_expressions()));
    out.push_back(expression.facts().id);
  }
  return out;
}

}  // namespace lab_io
}  // namespace tractus
