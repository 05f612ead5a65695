#include "effects/effect.hpp"

namespace effects {

std::string_view name(Kind kind) {
  switch (kind) {
    case Kind::force:
      return "force";
    case Kind::structure:
      return "structure";
    case Kind::measurement:
      return "measurement";
  }
  return "";
}

}  // namespace effects
