/// Pictures as PNG [ISO/IEC 15948], so that a person can look at them.
#include <zlib.h>

#include <fstream>

#include "tests/support/openxr/runtime.hpp"

namespace tractus {
namespace fakexr {
namespace {

void put_number(std::string& out, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(number >> shift));
}

void put_chunk(std::string& out, const std::string& kind, const std::string& body) {
  put_number(out, static_cast<std::uint32_t>(body.size()));
  const std::string both = kind + body;
  out += both;
  put_number(out, static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(both.data()),
                                                   static_cast<uInt>(both.size()))));
}

}  // namespace

bool write_png(const std::string& path, const std::vector<unsigned char>& rgba, int width,
               int height) {
  std::string rows;  // from above; OpenGL counts from below
  for (int y = height - 1; y >= 0; --y) {
    rows.push_back(0);  // no filter
    for (int x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        rows.push_back(static_cast<char>(
            rgba[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * 4 + c]));
  }
  uLongf packed_size = compressBound(rows.size());
  std::string packed(packed_size, '\0');
  if (compress(reinterpret_cast<Bytef*>(packed.data()), &packed_size,
               reinterpret_cast<const Bytef*>(rows.data()), rows.size()) != Z_OK)
    return false;
  packed.resize(packed_size);
  std::string head;
  put_number(head, static_cast<std::uint32_t>(width));
  put_number(head, static_cast<std::uint32_t>(height));
  head += std::string("\x08\x02\x00\x00\x00", 5);  // 8 bits, RGB
  std::string out = "\x89PNG\r\n\x1a\n";
  put_chunk(out, "IHDR", head);
  put_chunk(out, "IDAT", packed);
  put_chunk(out, "IEND", "");
  return bool(std::ofstream(path, std::ios::binary) << out);
}

}  // namespace fakexr
}  // namespace tractus
