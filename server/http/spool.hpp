/// Stores the body of a request in a file, with bounded memory; worker threads write the file. Only
/// server.cpp uses it.
#pragma once

#include "server/http/stream.hpp"
//
#include <boost/asio/awaitable.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <filesystem>

#include "server/http/scratch_space.hpp"

namespace tractus::http {

/// A file with a body; the destructor deletes it.
struct SpooledFile {
  std::filesystem::path path;  ///< empty: the body was not stored in a file
  ScratchSpace::Share share;   ///< reservation in the scratch space
  int fd = -1;
  bool broken = false;  ///< writing the file failed

  SpooledFile() = default;
  ~SpooledFile();
  SpooledFile(const SpooledFile&) = delete;
  SpooledFile& operator=(const SpooledFile&) = delete;
};

struct SpoolLimits {
  const ScratchSpace* space;
  std::uint64_t max_bytes;
  std::chrono::milliseconds patience;  ///< for each piece; the whole body needs at least 256 KiB/s
};

/// Reads the whole body of the request whose head is in `parser` into a new file of mode 0600. The
/// message is moved out of `parser`; afterwards only its empty body may be read.
boost::asio::awaitable<boost::system::error_code> spool_body(
    Stream& stream, boost::beast::flat_buffer& buffer,
    boost::beast::http::request_parser<boost::beast::http::string_body>& parser,
    const SpoolLimits& limits, boost::asio::thread_pool& workers, SpooledFile& into);

}  // namespace tractus::http
