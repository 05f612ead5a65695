/// An S3 server of a test's own: Ceph's RADOS gateway, by rados_gateway.py.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <string>

namespace tractus::test_support {

/// Runs with this object, and ends with the test program however that ends. While it is there, its
/// credentials are in the environment (AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY).
class S3Server {
 public:
  /// Ends the test program with a line when Ceph is not installed or does not start.
  S3Server();
  ~S3Server();
  S3Server(const S3Server&) = delete;
  S3Server& operator=(const S3Server&) = delete;

  /// "http://127.0.0.1:PORT/tractus/PREFIX": its bucket, and names that begin with `prefix`.
  std::string address(const std::string& prefix) const;
  /// Of another bucket, which does not exist.
  std::string address_without_bucket() const;
  /// SIGKILL to the gateway; what it had stored stays. Then `start` before the next use.
  void kill_gateway() const;
  void start();
  pid_t gateway() const { return gateway_; }
  /// What the server itself notes of an object: an MD5 of one put whole, "MD5-N" of one put in N
  /// parts; empty if it is not there.
  std::string etag(const std::string& key);
  /// Of those that were begun and neither completed nor aborted, as the server lists them.
  int unfinished_uploads();

 private:
  std::string ask(const std::string& command);
  std::filesystem::path folder_;
  int port_ = 0;
  pid_t helper_ = -1, gateway_ = -1;
  std::FILE* to_ = nullptr;
  std::FILE* from_ = nullptr;
};

/// The one of this test program, made when first asked for.
S3Server& s3_server();

}  // namespace tractus::test_support
