/// A certificate authority of the house: made once beside the data, so that TLS is on from the
/// first minute without asking anybody. Stations trust it by its file; browsers once it is
/// installed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace tractus::http {

/// The files of a folder; keys are for their owner alone.
struct CertificateFiles {
  std::filesystem::path authority;      ///< "authority.pem": what others trust, no secret
  std::filesystem::path authority_key;  ///< signs; may be moved to a safer place, until renewal
  std::filesystem::path certificate;    ///< "server.pem": the server's, then the authority's
  std::filesystem::path key;
};
CertificateFiles certificate_files(const std::filesystem::path& folder);

/// "localhost", this machine's name, 127.0.0.1 and ::1.
std::vector<std::string> own_names();

/// Makes what is missing: an authority for ten years, a server's certificate for 397 days, both
/// ECDSA on P-256. A server's certificate that ends within 30 days of `now_utc_s`, or lacks one of
/// `names` (host names or addresses), is made anew. Errors: io; corrupt (a file that is no PEM);
/// not_found (a certificate is to be made, and the authority's key is not there).
core::Result<void> ensure_certificates(const std::filesystem::path& folder,
                                       const std::vector<std::string>& names,
                                       std::int64_t now_utc_s);

/// SHA-256 of the certificate in a PEM file, in pairs with colons, as browsers show it.
core::Result<std::string> fingerprint(const std::filesystem::path& certificate);

}  // namespace tractus::http
