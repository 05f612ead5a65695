/// A private certificate authority, made once beside the data, so that TLS works from the first
/// start without an external authority. Stations trust its certificate file; browsers trust it once
/// it is installed in them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace tractus::http {

/// The certificate files of a folder; only the owner may read the keys.
struct CertificateFiles {
  std::filesystem::path authority;  ///< "authority.pem": the authority's certificate, not secret
  std::filesystem::path authority_key;  ///< signs; may be moved to a safer place until renewal
  std::filesystem::path certificate;    ///< "server.pem": server certificate, then authority
  std::filesystem::path key;
};
CertificateFiles certificate_files(const std::filesystem::path& folder);

/// "localhost", this machine's name, 127.0.0.1 and ::1.
std::vector<std::string> own_names();

/// Makes the missing files: an authority valid for ten years, a server certificate valid for 397
/// days, both ECDSA on P-256. Replaces a server certificate that expires within 30 days of
/// `now_utc_s`, or lacks one of `names` (host names or addresses). Errors: io; corrupt (a file is
/// not PEM); not_found (a certificate must be made, but the authority's key is missing).
core::Result<void> ensure_certificates(const std::filesystem::path& folder,
                                       const std::vector<std::string>& names,
                                       std::int64_t now_utc_s);

/// SHA-256 of the certificate in a PEM file, in pairs with colons, as browsers show it.
core::Result<std::string> fingerprint(const std::filesystem::path& certificate);

}  // namespace tractus::http
