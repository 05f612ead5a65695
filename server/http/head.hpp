/// Checks the head of a request that Beast parsed, and converts it to a plain value. Only
/// server.cpp uses it.
#pragma once

#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include "server/http/message.hpp"
#include "server/http/networks.hpp"

namespace tractus::http {

using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;

std::string lower_case(boost::beast::string_view text);

/// @param peer     network address of the client
/// @param proxies  proxies whose header X-Forwarded-For is trusted; null: none
/// Errors: bad_input for an invalid target, a head without exactly one Host header, and a
/// Transfer-Encoding other than chunked, because the bytes after such a head would be read as the
/// next request.
core::Result<RequestHead> head_of(const Parser& parser, std::string peer, const Networks* proxies);

}  // namespace tractus::http
