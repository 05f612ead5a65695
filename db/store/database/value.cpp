#include "db/store/database/value.hpp"

#include <fmt/format.h>

#include "core/require.hpp"
#include "core/words.hpp"

namespace tractus {
namespace store {
namespace {
template <class T>
const T& held(const Value& value) {
  core::require(std::holds_alternative<T>(value), "a column holds the type its schema says");
  return std::get<T>(value);
}
bool is_null(const Value& value) { return std::holds_alternative<std::monostate>(value); }
/// The length of the character that begins with `lead`, and the least and most that its second byte
/// may be (RFC 3629, section 4); 0: none begins so.
struct Lead {
  std::size_t length;
  unsigned char low, high;
};
Lead lead_of(unsigned char lead) {
  if (lead > 0 && lead < 0x80) return {1, 0, 0};
  if (lead >= 0xc2 && lead <= 0xdf) return {2, 0x80, 0xbf};
  if (lead == 0xe0) return {3, 0xa0, 0xbf};
  if (lead == 0xed) return {3, 0x80, 0x9f};
  if (lead > 0xe0 && lead <= 0xef) return {3, 0x80, 0xbf};
  if (lead == 0xf0) return {4, 0x90, 0xbf};
  if (lead > 0xf0 && lead < 0xf4) return {4, 0x80, 0xbf};
  if (lead == 0xf4) return {4, 0x80, 0x8f};
  return {0, 0, 0};
}
}  // namespace

bool is_text(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const Lead lead = lead_of(static_cast<unsigned char>(text[i]));
    if (lead.length == 0 || text.size() - i < lead.length) return false;
    for (std::size_t k = 1; k < lead.length; ++k) {
      const auto byte = static_cast<unsigned char>(text[i + k]);
      if (byte < (k == 1 ? lead.low : 0x80) || byte > (k == 1 ? lead.high : 0xbf)) return false;
    }
    i += lead.length;
  }
  return true;
}

const Value& Row::value(std::size_t column) const {
  core::require(column < values_.size(), "a column asked for was selected");
  return values_[column];
}
std::int64_t Row::integer(std::size_t column) const { return held<std::int64_t>(value(column)); }
std::uint64_t Row::count(std::size_t column) const {
  core::require(integer(column) >= 0, "a count in the database is not negative");
  return static_cast<std::uint64_t>(integer(column));
}
bool Row::truth(std::size_t column) const { return integer(column) != 0; }
double Row::number(std::size_t column) const { return held<double>(value(column)); }
const std::string& Row::text(std::size_t column) const { return held<std::string>(value(column)); }
std::optional<double> Row::number_or_null(std::size_t column) const {
  return is_null(value(column)) ? std::nullopt : std::optional(number(column));
}
std::optional<bool> Row::truth_or_null(std::size_t column) const {
  return is_null(value(column)) ? std::nullopt : std::optional(truth(column));
}
std::optional<std::string> Row::text_or_null(std::size_t column) const {
  return is_null(value(column)) ? std::nullopt : std::optional(text(column));
}

core::Error Row::unknown_word(std::string_view what, const std::string& found,
                              const std::string& allowed) {
  return {core::Errc::corrupt,
          fmt::format("database: {}: '{}' is none of {}", what, core::one_line(found), allowed)};
}

}  // namespace store
}  // namespace tractus
