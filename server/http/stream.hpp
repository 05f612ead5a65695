/// The byte stream of one connection, with or without TLS. One type for both, so that Beast is
/// compiled only once. Only server.cpp uses it.
#pragma once

#include <utility>  // before Asio: 1.74 uses std::exchange without it
//
#include <boost/asio/async_result.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <filesystem>
#include <optional>

#include "core/result.hpp"

namespace tractus::http {

/// Satisfies Asio's AsyncReadStream and AsyncWriteStream. Time-outs are those of Beast's
/// tcp_stream.
class Stream {
 public:
  using executor_type = boost::beast::tcp_stream::executor_type;
  using Failure = boost::system::error_code;

  /// @param tls  must outlive the stream; null: no TLS
  Stream(boost::asio::ip::tcp::socket socket, boost::asio::ssl::context* tls)
      : tcp_(std::move(socket)) {
    if (tls) tls_.emplace(tcp_, *tls);
  }
  executor_type get_executor() noexcept { return tcp_.get_executor(); }
  boost::asio::ip::tcp::socket& socket() { return tcp_.socket(); }
  template <class Duration>
  void expires_after(Duration time) {
    tcp_.expires_after(time);
  }
  void expires_never() { tcp_.expires_never(); }
  bool is_tls() const noexcept { return tls_.has_value(); }

  template <class Token>
  auto async_handshake(Token&& token) {
    return tls_->async_handshake(boost::asio::ssl::stream_base::server, std::forward<Token>(token));
  }
  /// Sends the TLS close notification, so that the client can detect a truncated answer.
  template <class Token>
  auto async_shutdown(Token&& token) {
    return tls_->async_shutdown(std::forward<Token>(token));
  }

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(Failure, std::size_t)>(
        [this](auto&& handler, const Buffers& into) {
          using Handler = decltype(handler);
          if (tls_)
            tls_->async_read_some(into, std::forward<Handler>(handler));
          else
            tcp_.async_read_some(into, std::forward<Handler>(handler));
        },
        token, buffers);
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(Failure, std::size_t)>(
        [this](auto&& handler, const Buffers& from) {
          using Handler = decltype(handler);
          if (tls_)
            tls_->async_write_some(from, std::forward<Handler>(handler));
          else
            tcp_.async_write_some(from, std::forward<Handler>(handler));
        },
        token, buffers);
  }

 private:
  boost::beast::tcp_stream tcp_;
  std::optional<boost::asio::ssl::stream<boost::beast::tcp_stream&>> tls_;
};

/// TLS 1.2 (only ECDHE with AES-GCM or ChaCha20) and TLS 1.3, without renegotiation and
/// compression; browsers and libcurl support these. Errors: bad_input, naming the invalid file.
core::Result<boost::asio::ssl::context> tls_context(const std::filesystem::path& certificate,
                                                    const std::filesystem::path& key);

}  // namespace tractus::http
