/// One signed request to an S3 server, tried again where that may help.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "db/store/volumes/s3_store.hpp"

namespace tractus::store {

/// SHA-256 of no bytes.
inline constexpr const char* kSha256_of_nothing =
    "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";

struct S3Request {
  const char* method;
  std::string path = {};  ///< behind the address's URL, with its query, whose fields are in order
  core::ByteView body = {};
  std::string sha256 = kSha256_of_nothing;  ///< of the body
  std::uint64_t from = 0;                   ///< GET: the first byte
  std::optional<std::uint64_t> size = {};   ///< GET: how many; nothing: to the end
  ObjectStore::Take take = {};              ///< gets the body of an answer of status 2xx
  bool slow = false;  ///< the server may be silent for two minutes while it works
};

struct S3Answer {
  long status = 0;
  std::string body = {};  ///< at most 64 KiB
  std::string etag = {};
  std::uint64_t length_bytes = 0;  ///< of the body, as its header says
};

class S3Client {
 public:
  S3Client(S3Address address, S3Credentials credentials);
  ~S3Client();
  /// An answer of status 2xx or 404. Errors: unavailable, cancelled.
  core::Result<S3Answer> ask(const S3Request& request) const;

 private:
  struct Handle;
  std::unique_ptr<Handle> idle_handle() const;
  void set_headers(Handle& handle, const S3Request& request) const;
  void set_request(Handle& handle, const S3Request& request) const;

  S3Address address_;
  S3Credentials credentials_;
  mutable std::mutex mutex_;                           ///< guards `idle_`
  mutable std::vector<std::unique_ptr<Handle>> idle_;  ///< with their open connections
};

std::string percent_encoded(const std::string& text);

/// The text of the first element of this name in a document; empty if there is none.
std::string xml_text(const std::string& document, const std::string& element);

}  // namespace tractus::store
