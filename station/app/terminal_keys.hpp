/// Single keys from the terminal.
#pragma once

#include <termios.h>

#include <optional>

namespace tractus::app {

/// The terminal without waiting for a line, as long as this lives.
class RawTerminal {
 public:
  RawTerminal();
  ~RawTerminal();
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;

 private:
  termios before_{};
  bool changed_ = false;
};

/// Without waiting; nothing when none was typed.
std::optional<char> typed_key();

}  // namespace tractus::app
