/// A request's body that goes to a file: in bounded memory, written by workers. For server.cpp
/// alone.
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

/// Gone with this.
struct SpooledFile {
  std::filesystem::path path;  ///< empty: the body did not go to a file
  ScratchSpace::Share share;   ///< of the space that its folder has
  int fd = -1;
  bool broken = false;  ///< it could not be written

  SpooledFile() = default;
  ~SpooledFile();
  SpooledFile(const SpooledFile&) = delete;
  SpooledFile& operator=(const SpooledFile&) = delete;
};

struct SpoolLimits {
  const ScratchSpace* space;
  std::uint64_t max_bytes;
  std::chrono::milliseconds patience;  ///< for each piece; and all of it at 256 KiB/s at least
};

/// Reads the body of a request whose head `parser` holds, to its end, into a new file of mode 0600.
/// `parser` gives up its message and is not to be read from afterwards but for its empty body.
boost::asio::awaitable<boost::system::error_code> spool_body(
    Stream& stream, boost::beast::flat_buffer& buffer,
    boost::beast::http::request_parser<boost::beast::http::string_body>& parser,
    const SpoolLimits& limits, boost::asio::thread_pool& workers, SpooledFile& into);

}  // namespace tractus::http
