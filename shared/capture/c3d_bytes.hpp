/// A C3D file's bytes and its parameters, whatever the processor that wrote them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/bytes.hpp"

namespace tractus::capture::detail {

/// What stands beyond the end reads as zero: who needs it whole asks `has` first.
class C3dBytes {
 public:
  enum class Processor { intel = 84, dec = 85, mips = 86 };

  explicit C3dBytes(core::Bytes bytes) : bytes_(std::move(bytes)) {}
  void written_by(Processor processor) { processor_ = processor; }
  std::size_t size() const { return bytes_.size(); }
  bool has(std::size_t at, std::size_t count) const { return at <= size() && count <= size() - at; }
  std::uint8_t byte(std::size_t at) const { return has(at, 1) ? std::uint8_t(bytes_[at]) : 0; }
  std::uint16_t word(std::size_t at) const;
  double integer(std::size_t at) const { return std::int16_t(word(at)); }
  /// IEEE single, or DEC's F float.
  double real(std::size_t at) const;
  /// Without blanks and zeros at its end; what would break a line is '?'.
  std::string text(std::size_t at, std::size_t count) const;

 private:
  core::Bytes bytes_;
  Processor processor_ = Processor::intel;
};

struct C3dParameter {
  int type = 0;  ///< −1 characters, 1 bytes, 2 integers, 4 floats
  std::vector<std::size_t> dims;
  std::size_t at = 0;  ///< of its data in the file
};

/// By "GROUP:NAME" in capitals.
class C3dParameters {
 public:
  /// @param start  of the parameter section
  C3dParameters(const C3dBytes& file, std::size_t start);
  std::optional<double> number(const std::string& name, std::size_t index = 0) const;
  std::optional<std::string> text(const std::string& name) const;
  /// LABELS, LABELS2, …: one for each of `count`; "STEM7" where there is none.
  std::vector<std::string> labels(const std::string& name, std::size_t count,
                                  const std::string& stem) const;

 private:
  const C3dBytes& file_;
  std::map<std::string, C3dParameter> all_;
};

}  // namespace tractus::capture::detail
