#include "server/http/certificates.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>

#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace http {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kDay_s = 86'400;
constexpr std::int64_t kAuthorityDays = 3652, kServerDays = 397, kRenewDays = 30;
constexpr std::uint64_t kMaxPem_bytes = 64 * 1024;

template <auto Free>
struct With {
  template <class T>
  void operator()(T* held) const {
    Free(held);
  }
};
using Key = std::unique_ptr<EVP_PKEY, With<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, With<X509_free>>;
using Memory = std::unique_ptr<BIO, With<BIO_free_all>>;

core::Result<Memory> opened(const fs::path& path) {
  auto bytes = TRY(core::read_file(path, kMaxPem_bytes));
  Memory out(BIO_new(BIO_s_mem()));
  core::require(out && BIO_write(out.get(), bytes.data(), static_cast<int>(bytes.size())) ==
                           static_cast<int>(bytes.size()),
                "memory takes a small file");
  return out;
}

core::Result<Certificate> read_certificate(const fs::path& path) {
  auto file = TRY(opened(path));
  Certificate out(PEM_read_bio_X509(file.get(), nullptr, nullptr, nullptr));
  if (!out)
    return core::Error{core::Errc::corrupt,
                       path.string() + ": the file has no certificate in PEM format"};
  return out;
}

core::Result<Key> read_key(const fs::path& path) {
  auto file = TRY(opened(path));
  Key out(PEM_read_bio_PrivateKey(file.get(), nullptr, nullptr, nullptr));
  if (!out)
    return core::Error{core::Errc::corrupt,
                       path.string() + ": the file has no private key in PEM format"};
  return out;
}

std::string text_in(BIO* memory) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(memory, &data);
  return {data, static_cast<std::size_t>(size)};
}

std::string pem_of(X509* certificate) {
  const Memory out(BIO_new(BIO_s_mem()));
  core::require(PEM_write_bio_X509(out.get(), certificate) == 1, "a certificate becomes PEM");
  return text_in(out.get());
}

std::string pem_of(EVP_PKEY* key) {
  const Memory out(BIO_new(BIO_s_mem()));
  core::require(
      PEM_write_bio_PKCS8PrivateKey(out.get(), key, nullptr, nullptr, 0, nullptr, nullptr) == 1,
      "a key becomes PEM");
  return text_in(out.get());
}

/// Called before the server has threads: the mask is the process's.
core::Result<void> write(const fs::path& path, const std::string& text) {
  const mode_t before = ::umask(0077);
  auto written = core::write_file(path, core::bytes_of(text));
  ::umask(before);
  return written;
}

Key new_key() {
  Key out(EVP_EC_gen("P-256"));
  core::require(bool(out), "a key on P-256 can be made");
  return out;
}

void extend(X509* certificate, X509* issuer, int what, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  X509_EXTENSION* made = X509V3_EXT_conf_nid(nullptr, &context, what, value.c_str());
  core::require(made != nullptr, "an extension of ours is well formed");
  X509_add_ext(certificate, made, -1);
  X509_EXTENSION_free(made);
}

/// Everything but extensions and signature.
Certificate blank(EVP_PKEY* key, const std::string& name, std::int64_t now_utc_s,
                  std::int64_t days) {
  Certificate out(X509_new());
  X509_set_version(out.get(), X509_VERSION_3);
  std::array<unsigned char, 16> serial{};
  core::require(RAND_bytes(serial.data(), int(serial.size())) == 1, "there is randomness");
  serial[0] = static_cast<unsigned char>((serial[0] & 0x3f) | 0x40);  // positive, of full length
  BIGNUM* number = BN_bin2bn(serial.data(), int(serial.size()), nullptr);
  BN_to_ASN1_INTEGER(number, X509_get_serialNumber(out.get()));
  BN_free(number);
  ASN1_TIME_set(X509_getm_notBefore(out.get()), now_utc_s - kDay_s);  // for clocks that are late
  ASN1_TIME_set(X509_getm_notAfter(out.get()), now_utc_s + days * kDay_s);
  X509_set_pubkey(out.get(), key);
  X509_NAME_add_entry_by_txt(X509_get_subject_name(out.get()), "CN", MBSTRING_UTF8,
                             reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0);
  return out;
}

void sign(X509* certificate, X509* issuer, EVP_PKEY* issuers_key) {
  X509_set_issuer_name(certificate, X509_get_subject_name(issuer));
  core::require(X509_sign(certificate, issuers_key, EVP_sha256()) > 0, "a certificate is signed");
}

core::Result<void> make_authority(const CertificateFiles& files, std::int64_t now_utc_s) {
  const Key key = new_key();
  const auto names = own_names();
  const Certificate made =
      blank(key.get(), "Tractus authority of " + names[1].substr(0, 40), now_utc_s, kAuthorityDays);
  extend(made.get(), made.get(), NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
  extend(made.get(), made.get(), NID_key_usage, "critical,keyCertSign,cRLSign");
  extend(made.get(), made.get(), NID_subject_key_identifier, "hash");
  sign(made.get(), made.get(), key.get());
  TRY(write(files.authority_key, pem_of(key.get())));
  return write(files.authority, pem_of(made.get()));
}

bool is_address(const std::string& name) {
  ASN1_OCTET_STRING* address = a2i_IPADDRESS(name.c_str());
  const bool is = address != nullptr;
  ASN1_OCTET_STRING_free(address);
  return is;
}

core::Result<void> make_server(const CertificateFiles& files, const std::vector<std::string>& names,
                               std::int64_t now_utc_s) {
  auto authority = TRY(read_certificate(files.authority));
  auto authority_key = TRY(read_key(files.authority_key));
  const Key key = new_key();
  const Certificate made = blank(key.get(), names.front().substr(0, 60), now_utc_s, kServerDays);
  X509* issuer = authority.get();
  extend(made.get(), issuer, NID_basic_constraints, "critical,CA:FALSE");
  extend(made.get(), issuer, NID_key_usage, "critical,digitalSignature");
  extend(made.get(), issuer, NID_ext_key_usage, "serverAuth");
  extend(made.get(), issuer, NID_subject_key_identifier, "hash");
  extend(made.get(), issuer, NID_authority_key_identifier, "keyid");
  std::string also;
  for (const std::string& name : names)
    also += fmt::format("{}{}:{}", also.empty() ? "" : ",", is_address(name) ? "IP" : "DNS", name);
  extend(made.get(), issuer, NID_subject_alt_name, also);
  sign(made.get(), issuer, authority_key.get());
  TRY(write(files.key, pem_of(key.get())));
  return write(files.certificate, pem_of(made.get()) + pem_of(issuer));
}

bool covers(X509* certificate, const std::string& name) {
  return is_address(name)
             ? X509_check_ip_asc(certificate, name.c_str(), 0) == 1
             : X509_check_host(certificate, name.c_str(), name.size(), 0, nullptr) == 1;
}

/// Is the server's certificate there, of this authority, of its key, for all names, and not about
/// to end?
bool serves(const CertificateFiles& files, const std::vector<std::string>& names,
            std::int64_t now_utc_s) {
  const auto certificate = read_certificate(files.certificate);
  const auto key = read_key(files.key);
  const auto authority = read_certificate(files.authority);
  if (!certificate || !key || !authority) return false;
  time_t soon = now_utc_s + kRenewDays * kDay_s;
  X509* held = certificate->get();
  return X509_cmp_time(X509_get0_notAfter(held), &soon) > 0 &&
         X509_check_private_key(held, key->get()) == 1 &&
         X509_verify(held, X509_get0_pubkey(authority->get())) == 1 &&
         std::ranges::all_of(names, [&](const auto& name) { return covers(held, name); });
}

/// They stand in a configuration line of the certificate: nothing that could be more than a name.
core::Result<void> check_names(const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (name.empty() || name.size() > 253 ||
        !std::ranges::all_of(
            name,
            [](unsigned char c) { return std::isalnum(c) || c == '.' || c == '-' || c == ':'; }) ||
        (name.find(':') != std::string::npos && !is_address(name)))
      return core::Error{core::Errc::bad_input,
                         name + ": a host name or an address is expected in a certificate"};
  return {};
}

}  // namespace

CertificateFiles certificate_files(const fs::path& folder) {
  return {folder / "authority.pem", folder / "authority.key", folder / "server.pem",
          folder / "server.key"};
}

std::vector<std::string> own_names() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  std::string own(name.data());
  if (own.empty() || !check_names({own})) own = "localhost";
  return {"localhost", own, "127.0.0.1", "::1"};
}

core::Result<void> ensure_certificates(const fs::path& folder,
                                       const std::vector<std::string>& names,
                                       std::int64_t now_utc_s) {
  TRY(check_names(names));
  const CertificateFiles files = certificate_files(folder);
  if (serves(files, names, now_utc_s)) return {};
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure)
    return core::Error{core::Errc::io,
                       fmt::format("{}: cannot create: {}", folder.string(), failure.message())};
  if (!fs::exists(files.authority, failure)) TRY(make_authority(files, now_utc_s));
  return make_server(files, names, now_utc_s);
}

core::Result<std::string> fingerprint(const fs::path& certificate) {
  auto held = TRY(read_certificate(certificate));
  std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
  unsigned size = 0;
  core::require(X509_digest(held.get(), EVP_sha256(), hash.data(), &size) == 1, "SHA-256 is there");
  std::string out;
  for (unsigned i = 0; i < size; ++i) out += fmt::format("{}{:02X}", i ? ":" : "", hash[i]);
  return out;
}

}  // namespace http
}  // namespace tractus
