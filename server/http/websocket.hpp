/// One WebSocket over a connection, RFC 6455, implemented with Beast. Only server.cpp uses it.
#pragma once

#include <utility>  // before Asio: 1.74 uses std::exchange without it
//
#include <boost/asio/awaitable.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include "server/http/stream.hpp"
#include "server/http/websocket_handler.hpp"

namespace tractus::http {

struct WebSocketTimes {
  std::chrono::milliseconds silence;  ///< without a received byte; a ping is sent after half of it
  std::chrono::milliseconds write;    ///< largest time for sending one message
};

/// Accepts the upgrade and runs the WebSocket until it is closed. Text messages only, no
/// compression.
boost::asio::awaitable<void> hold_conversation(
    Stream& stream, const boost::beast::http::request<boost::beast::http::string_body>& upgrade,
    std::shared_ptr<WebSocketHandler> with, boost::asio::thread_pool& workers,
    WebSocketTimes times);

}  // namespace tractus::http
