/// One WebSocket over a connection, RFC 6455 by Beast. For server.cpp alone.
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
  std::chrono::milliseconds silence;  ///< without a byte; a ping is sent at half of it
  std::chrono::milliseconds write;    ///< for one message to leave
};

/// Accepts the upgrade and holds the conversation to its end. No compression, text alone.
boost::asio::awaitable<void> hold_conversation(
    Stream& stream, const boost::beast::http::request<boost::beast::http::string_body>& upgrade,
    std::shared_ptr<WebSocketHandler> with, boost::asio::thread_pool& workers,
    WebSocketTimes times);

}  // namespace tractus::http
