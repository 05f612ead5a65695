/// A request's head as Beast parsed it, checked and made a plain value. For server.cpp alone.
#pragma once

#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include "server/http/message.hpp"
#include "server/http/networks.hpp"

namespace tractus::http {

using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;

std::string lower_case(boost::beast::string_view text);

/// @param peer     the other side's address
/// @param proxies  believed when they name the peer in X-Forwarded-For; null: none
/// Errors: bad_input for a target that cannot be read, a head without exactly one Host, and a
/// Transfer-Encoding other than chunked: what follows such a head would be read as the next
/// request.
core::Result<RequestHead> head_of(const Parser& parser, std::string peer, const Networks* proxies);

}  // namespace tractus::http
