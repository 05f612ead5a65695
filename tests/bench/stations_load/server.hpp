/// A real `tractus-server` as its users start it, with stations enrolled and a case published.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace tractus::load {

class Server {
 public:
  /// Makes `folder` anew. @param plain  without TLS
  static core::Result<Server> start(const std::filesystem::path& folder, int stations, bool plain);
  ~Server();
  Server(Server&& other) noexcept;
  Server& operator=(Server&&) = delete;

  const std::string& url() const { return url_; }
  const std::filesystem::path& authority() const { return authority_; }  ///< empty: plain
  const std::string& case_id() const { return case_id_; }
  const std::string& token(std::size_t station) const { return tokens_[station]; }
  /// The admin's, as the header Cookie has it.
  core::Result<std::string> cookie() const;
  /// Resident memory, bytes, and processor time so far, s.
  double resident_bytes() const;
  double processor_s() const;

 private:
  Server() = default;
  std::filesystem::path folder_, authority_;
  std::string url_, case_id_;
  std::vector<std::string> tokens_;
  pid_t pid_ = -1;
  int output_ = -1;
};

}  // namespace tractus::load
