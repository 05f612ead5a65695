/// Objects in a bucket of an S3 server: Amazon's, Ceph's RADOS gateway, or another of that protocol.
#pragma once

#include <memory>
#include <string>

#include "db/store/volumes/object_store.hpp"

namespace tractus::store {

/// A bucket, and what the names in it begin with.
struct S3Address {
  std::string url;     ///< "https://HOST[:PORT]/BUCKET[/PREFIX]", without "/" at its end
  std::string region;  ///< that the signatures name

  /// From "https://HOST[:PORT]/BUCKET[/PREFIX][?region=REGION]"; the region is us-east-1 if none is
  /// named. Errors: bad_input.
  static core::Result<S3Address> parse(const std::string& text);
};

struct S3Credentials {
  std::string key_id, secret, session_token;  ///< the token may be empty

  /// From AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY and AWS_SESSION_TOKEN, else from the section
  /// AWS_PROFILE (default: "default") of the file AWS_SHARED_CREDENTIALS_FILE (default:
  /// ~/.aws/credentials). Errors: bad_input, those of reading the file.
  static core::Result<S3Credentials> find();
};

/// An object ab…: URL/ab/…. Requests are signed (Signature Version 4, by libcurl) with the SHA-256 of
/// their body, which the server checks; objects over 16 MiB are put in parts of that size. A request
/// that meets no answer, or a server in trouble, is tried up to four times within 20 s.
std::unique_ptr<ObjectStore> open_s3(S3Address address, S3Credentials credentials);

}  // namespace tractus::store
