/// Words for a person.
#pragma once

#include <string>
#include <string_view>

namespace tractus::core {

/// `text` as one bearable line: control characters become '?', what is over `most` bytes is cut at
/// a character's edge and ends in "…". For what somebody else wrote and a message repeats.
std::string one_line(std::string_view text, std::size_t most = 200);

/// The number of characters of a UTF-8 text; fmt pads by bytes.
std::size_t characters(std::string_view text);

}  // namespace tractus::core
