#include "fmu/module/file_uri.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>

namespace tractus {
namespace fmu {

core::Result<std::filesystem::path> path_of(std::string_view uri) {
  std::string_view rest = uri;
  if (rest.starts_with("file:")) {
    rest.remove_prefix(5);
    if (rest.starts_with("//")) rest.remove_prefix(std::min(rest.find('/', 2), rest.size()));
  }
  if (!rest.starts_with('/'))
    return core::Error{
        core::Errc::bad_input,
        fmt::format("resourceLocation '{}': a file URI is expected, as file:///folder",
                    uri.substr(0, 200))};
  std::string path;
  for (std::size_t k = 0; k < rest.size(); ++k) {
    const auto digits = rest.substr(k + 1, 2);
    const bool code = rest[k] == '%' && digits.size() == 2 &&
                      std::ranges::all_of(digits, [](unsigned char c) { return std::isxdigit(c); });
    path += code ? char(std::stoi(std::string(digits), nullptr, 16)) : rest[k];
    if (code) k += 2;
  }
  return std::filesystem::path(path);
}

}  // namespace fmu
}  // namespace tractus
