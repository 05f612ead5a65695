/// What becomes of each attribute of a DICOM file: the standard's table, and ours of what is kept.
///
/// The Basic Application Level Confidentiality Profile (PS3.15 annex E) says of each attribute that
/// may identify somebody what is to become of it: X removed, Z emptied, D replaced by a dummy, U
/// replaced by a new identifier; "X/Z" and the like leave it to what the object's definition asks.
/// It leaves open what else a file may hold. We are stricter: what is not in `kept_row` is removed,
/// listed or not, whatever its representation, public or private, nested or not. So Z and D become
/// removal as well, and no sequence is kept.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace tractus::volume_io {

/// The edition that the rows were taken from, for reports.
inline constexpr std::string_view kProfile =
    "DICOM PS3.15 2024b, Table E.1-1, Basic Profile and Clean Descriptors";

/// The action of Table E.1-1 in its own letters ("X", "Z", "U", "X/Z/D" …); empty: not listed.
std::string_view profile_action(std::uint32_t tag);

/// How a kept attribute's value must look. One that does not is refused, or made to: a value is
/// never passed on unread.
enum class Form {
  terms,     ///< words of the row's list; another becomes OTHER where the list has it, else nothing
  decimals,  ///< numbers between backslashes
  two_bytes,  ///< one 16-bit number
  new_uid,    ///< replaced by a keyed hash of itself
  pixels,
};
struct KeptRow {
  std::uint32_t tag;
  Form form;
  std::string_view terms;  ///< between blanks
};
/// Nothing for what is removed.
std::optional<KeptRow> kept_row(std::uint32_t tag);

}  // namespace tractus::volume_io
