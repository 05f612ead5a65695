#include "station/app/terminal_keys.hpp"

#include <poll.h>
#include <unistd.h>

namespace tractus {
namespace app {

RawTerminal::RawTerminal() {
  if (!::isatty(STDIN_FILENO) || ::tcgetattr(STDIN_FILENO, &before_) != 0) return;
  termios raw = before_;
  raw.c_lflag &= ~tcflag_t(ICANON | ECHO);
  changed_ = ::tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0;
}

RawTerminal::~RawTerminal() {
  if (changed_) ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

std::optional<char> typed_key() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  char c = 0;
  if (::poll(&input, 1, 0) <= 0 || ::read(STDIN_FILENO, &c, 1) != 1) return std::nullopt;
  return c;
}

}  // namespace app
}  // namespace tractus
