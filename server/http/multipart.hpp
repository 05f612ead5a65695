/// Bodies of several parts (RFC 2046, section 5.1), as DICOMweb sends files.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace tractus::http {

/// "multipart/related; type=\"application/dicom\"; boundary=b": the type in lower case, and the
/// boundary, empty if it states none.
struct MediaType {
  std::string type, boundary;
};
MediaType media_type_of(std::string_view header);

/// Splits a body that comes piece by piece. Memory: one piece and a part's headers.
class Multipart {
 public:
  /// Each part: its type in lower case, then its bytes piece by piece, then its end.
  struct Sink {
    std::function<core::Result<void>(const std::string& type)> begin;
    std::function<core::Result<void>(std::string_view bytes)> bytes;
    std::function<core::Result<void>()> end;
  };

  static constexpr std::size_t kMaxBoundary = 200;  ///< RFC 2046 has 70

  /// @param boundary  of 1 to kMaxBoundary characters
  /// @param who  sends the body, for messages
  Multipart(std::string_view boundary, std::string who, Sink sink);

  /// Errors: bad_input (a part's headers have no end); those of the sink.
  core::Result<void> take(std::string_view piece);
  /// After the last piece. Errors: bad_input if the last boundary has not come.
  core::Result<void> finish() const;

 private:
  enum class State { before, delimiter, headers, body, after };
  core::Error wrong(std::string_view why) const;
  core::Result<bool> step();
  core::Result<bool> pass_bytes();
  core::Result<bool> read_delimiter();
  core::Result<bool> read_headers();

  std::string delimiter_;  ///< CRLF, two hyphens and the boundary
  std::string who_;
  Sink sink_;
  State state_ = State::before;
  std::string held_ = "\r\n";  ///< not yet taken: the first delimiter needs no CRLF before it
};

}  // namespace tractus::http
