/// Work that worker threads do for a connection (see on_workers): each type calls one function of
/// the service. Only server.cpp uses it.
#pragma once

#include <fmt/format.h>

#include "server/http/server.hpp"

namespace tractus::http {

using Admission = std::variant<Admitted, Response>;
using Opening = std::variant<Response, std::shared_ptr<WebSocketHandler>>;
using Ranked = std::variant<Standing, Response>;

/// The response if a library throws unexpectedly: this request fails, and the server continues.
inline Response broken(const std::exception& failure) {
  fmt::print(stderr, "tractus-server: a request failed: {}\n", failure.what());
  return error_response(500, "io",
                        "the request failed inside the server; the reason is in the server's log");
}

struct Handling {
  const Service* service;
  const Request* request;
  Response operator()() const try {
    return service->handle(*request);
  } catch (const std::exception& failure) {
    return broken(failure);
  }
};
/// The next piece of a body that is made while it is sent; false when it cannot be made.
struct MakingPiece {
  BodySource* source;
  std::string* piece;
  bool operator()() const try {
    return bool(source->read(*piece));
  } catch (const std::exception& failure) {
    broken(failure);
    return false;
  }
};
struct Admitting {
  const Service* service;
  const RequestHead* head;
  Admission operator()() const try {
    return service->admit(*head);
  } catch (const std::exception& failure) {
    return broken(failure);
  }
};
struct Ranking {
  const Service* service;
  const RequestHead* head;
  Ranked operator()() const try {
    return service->standing(*head);
  } catch (const std::exception& failure) {
    return broken(failure);
  }
};
struct OpeningWebSocket {
  const Service* service;
  const RequestHead* head;
  Opening operator()() const try {
    return service->converse(*head);
  } catch (const std::exception& failure) {
    return broken(failure);
  }
};

}  // namespace tractus::http
