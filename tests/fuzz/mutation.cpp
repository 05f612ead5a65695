#include "fuzz/mutation.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace tractus::fuzz {

core::Bytes mutated(core::Bytes bytes, std::mt19937& random, Texts texts) {
  static const std::vector<std::string> kExtremes{"-1",
                                                  "1e999",
                                                  "99999999999999999999",
                                                  "null",
                                                  "\"\"",
                                                  "[]",
                                                  "{}",
                                                  "NaN",
                                                  "\xff\xfe",
                                                  "\n",
                                                  ",",
                                                  "0",
                                                  "../../etc/passwd",
                                                  "%00",
                                                  "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["};
  const auto below = [&](std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
  };
  for (std::size_t turn = 1 + below(4); turn > 0 && !bytes.empty(); --turn) {
    const std::size_t at = below(bytes.size());
    const std::size_t length = 1 + below(std::min<std::size_t>(bytes.size() - at, 200));
    const auto begin = bytes.begin() + std::ptrdiff_t(at), end = begin + std::ptrdiff_t(length);
    switch (below(texts == Texts::too ? 6 : 5)) {
      case 0:
        *begin = std::byte(below(256));
        break;
      case 1:
        bytes.erase(begin, end);
        break;
      case 2: {
        const core::Bytes part(begin, end);
        bytes.insert(end, part.begin(), part.end());
        break;
      }
      case 3:
        std::fill(begin, end, std::byte{});
        break;
      case 4:
        std::fill(begin, begin + std::ptrdiff_t(std::min<std::size_t>(length, 4)), std::byte{0xff});
        break;
      default: {
        const auto extreme = core::bytes_of(kExtremes[below(kExtremes.size())]);
        bytes.insert(begin, extreme.begin(), extreme.end());
      }
    }
  }
  return bytes;
}

}  // namespace tractus::fuzz
