#include "capture/c3d_bytes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>

namespace tractus::capture::detail {
namespace {
constexpr int kMostParameters = 10'000;
}

std::uint16_t C3dBytes::word(std::size_t at) const {
  const unsigned first = byte(at), second = byte(at + 1);
  return std::uint16_t(processor_ == Processor::mips ? first << 8 | second : second << 8 | first);
}

double C3dBytes::real(std::size_t at) const {
  const std::uint32_t first = word(at), second = word(at + 2);
  if (processor_ == Processor::intel) return double(std::bit_cast<float>(second << 16 | first));
  if (processor_ == Processor::mips) return double(std::bit_cast<float>(first << 16 | second));
  // DEC's F float: the words the other way round, an exponent that counts from 129.
  return double(std::bit_cast<float>(first << 16 | second)) / 4.0;
}

std::string C3dBytes::text(std::size_t at, std::size_t count) const {
  std::string out;
  for (std::size_t k = 0; k < count && has(at + k, 1); ++k) {
    const std::uint8_t c = byte(at + k);
    out += c == 0 ? ' ' : c < 0x20 || c == 0x7f ? '?' : char(c);
  }
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

C3dParameters::C3dParameters(const C3dBytes& file, std::size_t start) : file_(file) {
  std::map<int, std::string> groups;
  std::vector<std::pair<int, std::pair<std::string, C3dParameter>>> found;
  std::size_t at = start + 4;
  for (int guard = 0; guard < kMostParameters && file.has(at, 4); ++guard) {
    // A name's length is negative when it is locked; groups have negative numbers.
    const auto length = std::size_t(std::abs(int(std::int8_t(file.byte(at)))));
    const int group = std::int8_t(file.byte(at + 1));
    if (length == 0 || group == 0) break;
    std::string name = file.text(at + 2, length);
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return char(std::toupper(c)); });
    const std::size_t next_at = at + 2 + length;
    if (group < 0) {
      groups[-group] = name;
    } else {
      C3dParameter p{.type = std::int8_t(file.byte(next_at + 2)), .dims = {}, .at = 0};
      const std::size_t count = file.byte(next_at + 3);
      for (std::size_t d = 0; d < count; ++d) p.dims.push_back(file.byte(next_at + 4 + d));
      p.at = next_at + 4 + count;
      found.emplace_back(group, std::pair(name, p));
    }
    const std::size_t next = file.word(next_at);
    if (next == 0) break;
    at = next_at + next;
  }
  for (const auto& [group, named] : found) all_[groups[group] + ":" + named.first] = named.second;
}

std::optional<double> C3dParameters::number(const std::string& name, std::size_t index) const {
  const auto p = all_.find(name);
  if (p == all_.end()) return std::nullopt;
  std::size_t count = 1;
  for (const std::size_t d : p->second.dims) count *= d;
  const int type = p->second.type;
  const std::size_t each = type == 4 ? 4 : type == 2 ? 2 : 1;
  if (index >= count || type < 1 || !file_.has(p->second.at + index * each, each))
    return std::nullopt;
  const std::size_t at = p->second.at + index * each;
  return each == 4 ? file_.real(at) : each == 2 ? file_.integer(at) : double(file_.byte(at));
}

std::optional<std::string> C3dParameters::text(const std::string& name) const {
  const auto p = all_.find(name);
  if (p == all_.end() || p->second.type != -1 || p->second.dims.empty()) return std::nullopt;
  return file_.text(p->second.at, p->second.dims[0]);
}

std::vector<std::string> C3dParameters::labels(const std::string& name, std::size_t count,
                                               const std::string& stem) const {
  std::vector<std::string> out;
  for (int part = 1; out.size() < count && part < 100; ++part) {
    const auto p = all_.find(part == 1 ? name : fmt::format("{}{}", name, part));
    if (p == all_.end() || p->second.type != -1 || p->second.dims.size() != 2) break;
    const std::size_t length = p->second.dims[0];
    for (std::size_t k = 0; k < p->second.dims[1] && out.size() < count; ++k)
      out.push_back(file_.text(p->second.at + k * length, length));
  }
  for (std::size_t k = 0; k < count; ++k) {
    if (k == out.size()) out.emplace_back();
    if (out[k].empty()) out[k] = fmt::format("{}{}", stem, k + 1);
  }
  return out;
}

}  // namespace tractus::capture::detail
