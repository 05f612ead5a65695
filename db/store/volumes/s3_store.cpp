#include "db/store/volumes/s3_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <boost/property_tree/ini_parser.hpp>
#include <cstdlib>
#include <vector>

#include "core/require.hpp"
#include "core/try.hpp"
#include "db/store/volumes/file_pieces.hpp"
#include "db/store/volumes/s3_request.hpp"
#include "db/store/volumes/store_away.hpp"

namespace tractus {
namespace store {
namespace fs = std::filesystem;
namespace {

using core::Errc;
using core::Error;
using core::Result;

/// Of an object that is put in one request, and of a part; S3 asks for at least 5 MiB and takes up to
/// 10 000 parts.
constexpr std::size_t kPart_bytes = 16u << 20;

std::string path_of_object(const std::string& sha256) {
  core::require(core::is_sha256(sha256), "an object is named by a SHA-256");
  return "/" + sha256.substr(0, 2) + "/" + sha256.substr(2);
}

Error lost(const std::string& sha256, const std::string& how) {
  return store_away(fmt::format("object {}: {}", sha256, how));
}

std::string completion(const std::vector<std::string>& etags) {
  std::string out = "<CompleteMultipartUpload>";
  for (std::size_t i = 0; i < etags.size(); ++i)
    out += fmt::format("<Part><PartNumber>{}</PartNumber><ETag>{}</ETag></Part>", i + 1, etags[i]);
  return out + "</CompleteMultipartUpload>";
}

class S3Store final : public ObjectStore {
 public:
  S3Store(S3Address address, S3Credentials credentials)
      : client_(std::move(address), std::move(credentials)) {}

  Result<void> put(const std::string& sha256, const fs::path& file) const override {
    auto in = TRY(FilePieces::open(file));
    auto first = TRY(in.next(kPart_bytes));
    if (first.size() == kPart_bytes) return put_in_parts(sha256, in, std::move(first));
    if (core::sha256(first) != sha256) return wrong_content(file, sha256);
    return put_bytes(path_of_object(sha256), first, sha256);
  }

  Result<void> read(const std::string& sha256, std::uint64_t offset,
                    std::optional<std::uint64_t> size, const Take& take) const override {
    if (size == 0u) return {};
    const auto answer = TRY(client_.ask({.method = "GET",
                                         .path = path_of_object(sha256),
                                         .from = offset,
                                         .size = size,
                                         .take = take}));
    if (answer.status != 404) return {};
    return Error{Errc::not_found, "object store: no object " + sha256};
  }

  Result<std::optional<std::uint64_t>> size_of(const std::string& sha256) const override {
    const auto answer = TRY(client_.ask({.method = "HEAD", .path = path_of_object(sha256)}));
    return answer.status == 404 ? std::nullopt : std::optional(answer.length_bytes);
  }

  Result<void> remove(const std::string& sha256) const override {
    TRY(client_.ask({.method = "DELETE", .path = path_of_object(sha256)}));
    return {};
  }

 private:
  static Error wrong_content(const fs::path& file, const std::string& sha256) {
    return {Errc::corrupt, fmt::format("{}: its SHA-256 is not {}", file.string(), sha256)};
  }

  Result<void> put_bytes(const std::string& path, core::ByteView bytes, const std::string& sha256,
                         std::string* etag = nullptr) const {
    auto answer =
        TRY(client_.ask({.method = "PUT", .path = path, .body = bytes, .sha256 = sha256}));
    if (answer.status == 404) return store_away("refuses " + path);
    if (etag) *etag = std::move(answer.etag);
    return {};
  }

  /// Parts that were put when this fails are discarded: the object is there whole or not at all.
  Result<void> put_in_parts(const std::string& sha256, FilePieces& in, core::Bytes first) const {
    const std::string path = path_of_object(sha256);
    const auto begun = TRY(client_.ask({.method = "POST", .path = path + "?uploads="}));
    const std::string upload = percent_encoded(xml_text(begun.body, "UploadId"));
    if (upload.empty()) return lost(sha256, "no upload in parts was begun");
    const auto put = put_parts(path, upload, in, std::move(first), sha256);
    if (put) return check_size(sha256, in.bytes());
    const auto ignored = client_.ask({.method = "DELETE", .path = path + "?uploadId=" + upload});
    (void)ignored;  // what remains is discarded by a rule of the bucket (deploy/large/README.md)
    return put.error();
  }

  Result<void> put_parts(const std::string& path, const std::string& upload, FilePieces& in,
                         core::Bytes part, const std::string& sha256) const {
    core::Sha256 whole;
    std::vector<std::string> etags;
    while (!part.empty()) {
      whole.add(part);
      const std::string at =
          fmt::format("{}?partNumber={}&uploadId={}", path, etags.size() + 1, upload);
      TRY(put_bytes(at, part, core::sha256(part), &etags.emplace_back()));
      part = TRY(in.next(kPart_bytes));
    }
    if (whole.hex() != sha256) return wrong_content(in.path(), sha256);
    const std::string body = completion(etags);
    const auto answer = TRY(client_.ask({.method = "POST",
                                         .path = path + "?uploadId=" + upload,
                                         .body = core::bytes_of(body),
                                         .sha256 = core::sha256(core::bytes_of(body)),
                                         .slow = true}));
    // 404: this request was answered before, and the answer lost; the size tells.
    const std::string refused = xml_text(answer.body, "Code");  // may come with status 200
    if (answer.status != 404 && !refused.empty())
      return lost(sha256, "its parts were not put together: " + refused);
    return {};
  }

  Result<void> check_size(const std::string& sha256, std::uint64_t size_bytes) const {
    const auto kept = TRY(size_of(sha256));
    if (kept == size_bytes) return {};
    return lost(sha256, fmt::format("{} of {} bytes are there", kept.value_or(0), size_bytes));
  }

  S3Client client_;
};

bool is_word(const std::string& text, const char* more) {
  return !text.empty() && std::ranges::all_of(text, [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view(more).find(c) != std::string_view::npos;
  });
}

std::string from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

fs::path credentials_file() {
  const std::string named = from_environment("AWS_SHARED_CREDENTIALS_FILE");
  return named.empty() ? fs::path(from_environment("HOME")) / ".aws" / "credentials"
                       : fs::path(named);
}

}  // namespace

Result<S3Address> S3Address::parse(const std::string& text) {
  const auto wrong = Error{Errc::bad_input,
                           fmt::format("{}: https://HOST[:PORT]/BUCKET[/PREFIX][?region=REGION] is "
                                       "expected, of letters, digits and . _ -",
                                       text.substr(0, 200))};
  constexpr std::string_view kRegion = "?region=";
  const auto query = text.find('?');
  S3Address out{text.substr(0, query), "us-east-1"};
  if (query != std::string::npos) {
    if (!text.substr(query).starts_with(kRegion)) return wrong;
    out.region = text.substr(query + kRegion.size());
  }
  while (out.url.ends_with('/')) out.url.pop_back();
  const auto scheme = out.url.find("://");
  const auto path = scheme == std::string::npos ? scheme : out.url.find('/', scheme + 3);
  if (path == std::string::npos || !is_word(out.region, "-")) return wrong;
  const bool fine = is_word(out.url.substr(scheme + 3, path - scheme - 3), ".-:[]") &&
                    is_word(out.url.substr(path + 1), "._-/") &&
                    out.url.find("//", path) == std::string::npos &&
                    out.url.find("/.", path) == std::string::npos;
  return fine ? Result<S3Address>(std::move(out)) : Result<S3Address>(wrong);
}

Result<S3Credentials> S3Credentials::find() {
  S3Credentials out{from_environment("AWS_ACCESS_KEY_ID"),
                    from_environment("AWS_SECRET_ACCESS_KEY"),
                    from_environment("AWS_SESSION_TOKEN")};
  if (!out.key_id.empty() && !out.secret.empty()) return out;
  const fs::path file = credentials_file();
  const std::string profile = from_environment("AWS_PROFILE");
  const std::string section = profile.empty() ? "default" : profile;
  boost::property_tree::ptree read;
  try {
    boost::property_tree::read_ini(file.string(), read);
    const auto& values = read.get_child(section);
    out = {values.get("aws_access_key_id", ""), values.get("aws_secret_access_key", ""),
           values.get("aws_session_token", "")};
  } catch (const boost::property_tree::ptree_error&) {
    out = {};
  }
  if (!out.key_id.empty() && !out.secret.empty()) return out;
  return Error{Errc::bad_input,
               fmt::format("object store: no credentials: give them in AWS_ACCESS_KEY_ID and "
                           "AWS_SECRET_ACCESS_KEY, or in the section [{}] of {}",
                           section, file.string())};
}

std::unique_ptr<ObjectStore> open_s3(S3Address address, S3Credentials credentials) {
  return std::make_unique<S3Store>(std::move(address), std::move(credentials));
}

}  // namespace store
}  // namespace tractus
