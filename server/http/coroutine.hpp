/// Functions that the coroutines of server.cpp and websocket.cpp share; only these two files use
/// them.
#pragma once

#include <utility>  // before Asio: 1.74 uses std::exchange without it
//
#include <boost/asio/awaitable.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace tractus::http {

inline auto into(boost::system::error_code& failure) {
  return boost::asio::redirect_error(boost::asio::use_awaitable, failure);
}

/// Runs `work` on the pool and resumes the coroutine on the connection's own thread with the
/// result. `work` is a plain value of pointers into the waiting coroutine's frame, because gcc 12
/// destroys the captures of a lambda twice if the lambda is made within a co_await expression.
template <class Work>
boost::asio::awaitable<std::invoke_result_t<Work>> on_workers(boost::asio::thread_pool& pool,
                                                              Work work) {
  namespace net = boost::asio;
  using Answer = std::invoke_result_t<Work>;
  auto start = [&pool, &work](auto handler) {
    net::post(pool, [work = std::move(work), handler = std::move(handler)]() mutable {
      Answer answer = work();
      const auto home = net::get_associated_executor(handler);
      net::post(home, [handler = std::move(handler), answer = std::move(answer)]() mutable {
        std::move(handler)(std::move(answer));
      });
    });
  };
  co_return co_await net::async_initiate<const net::use_awaitable_t<>&, void(Answer)>(
      std::move(start), net::use_awaitable);
}

}  // namespace tractus::http
