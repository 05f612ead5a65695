#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

#include "cases/case.hpp"
#include "cases/png_salt.hpp"
#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace cases {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Fields;
using core::Json;
using core::Result;

constexpr const char* kSignatureFormat = "tractus-signature/1";
constexpr const char* kManifest = "case.json";
constexpr const char* kSignature = "case.sig";
constexpr std::uint64_t kMaxManifest_bytes = 1u << 20;
constexpr std::size_t kTruth_bytes = 1024;
constexpr std::size_t kCertificate_bytes = 65536;
constexpr std::size_t kPictureStep_bytes = 1u << 19;
constexpr std::size_t kRead_bytes = 1u << 20;

Error corrupt(const fs::path& path, const std::string& why) {
  return {Errc::corrupt, fmt::format("{}: {}", path.string(), why)};
}

/// Size and SHA-256 of a regular file (never through a link), read in pieces.
Result<Part> measured(const fs::path& path, bool secret) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (fd < 0) return core::system_error(path, "cannot open");
  struct stat info {};
  core::Sha256 hash;
  Part part{.name = path.filename().string(), .sha256 = {}, .size_bytes = 0, .secret = secret};
  std::vector<std::byte> piece(kRead_bytes);
  ssize_t n = ::fstat(fd, &info) == 0 && S_ISREG(info.st_mode) ? 1 : -1;
  while (n > 0 && (n = ::read(fd, piece.data(), piece.size())) > 0) {
    hash.add(std::span(piece).first(std::size_t(n)));
    part.size_bytes += std::uint64_t(n);
  }
  ::close(fd);
  if (n < 0) return Error{Errc::io, fmt::format("{}: cannot be read as a file", path.string())};
  part.sha256 = hash.hex();
  return part;
}

Result<void> write_signature(const fs::path& path, core::ByteView manifest,
                             const core::KeyPair& key) {
  return core::write_json(path, {{"format", kSignatureFormat},
                                 {"public_key", key.public_hex},
                                 {"signature", core::sign(manifest, key)}});
}

/// The signer's public key, if the signature holds.
Result<std::string> checked_signature(const fs::path& folder, core::ByteView manifest) {
  const fs::path path = folder / kSignature;
  auto bytes = core::read_file(path, 4096);
  if (!bytes)
    return bytes.error().code == Errc::not_found ? corrupt(path, "is missing") : bytes.error();
  auto json = core::parse_json(core::text_of(*bytes), path.string());
  if (!json) return corrupt(path, "is not a signature: " + json.error().what);
  Fields fields(*json, path.string() + ": ");
  const auto format = fields.text("format"), open_key = fields.text("public_key"),
             signature = fields.text("signature");
  if (auto done = fields.done(); !done) return Error{Errc::corrupt, done.error().what};
  if (format != kSignatureFormat)
    return corrupt(path, fmt::format("'{}' is not a format of signatures", format));
  if (!core::verify(manifest, signature, open_key))
    return corrupt(folder / kManifest,
                   "its signature does not hold: it was changed after it was signed");
  return open_key;
}

Result<void> check_part(const fs::path& folder, const Part& part) {
  const fs::path path = folder / part.name;
  std::error_code failure;
  const auto status = fs::symlink_status(path, failure);
  if (status.type() == fs::file_type::not_found)
    return part.secret ? Result<void>() : Result<void>(corrupt(path, "is missing"));
  if (status.type() != fs::file_type::regular) return corrupt(path, "is not a regular file");
  if (const auto size = fs::file_size(path, failure); failure || size != part.size_bytes)
    return corrupt(path, fmt::format("has {} bytes, the case says {}", size, part.size_bytes));
  const auto found = TRY(measured(path, part.secret));
  if (found.sha256 != part.sha256)
    return corrupt(path, "its content is not what the case says (SHA-256)");
  return {};
}

Result<void> check_nothing_else(const fs::path& folder, const std::vector<Part>& parts) {
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    const auto name = entry.path().filename().string();
    const bool known =
        name == kManifest || name == kSignature ||
        std::ranges::any_of(parts, [&](const Part& part) { return part.name == name; });
    if (!known) return corrupt(entry.path(), "is not part of the case");
  }
  if (failure) return Error{Errc::io, fmt::format("{}: {}", folder.string(), failure.message())};
  return {};
}

/// Writes a secret padded with blanks to one length for all, since the open manifest states it.
Result<void> write_padded(const fs::path& path, const Json& json, std::size_t bytes) {
  std::string text = json.dump(2);
  core::require(text.size() < bytes, "a secret part fits its length");
  text.resize(bytes - 1, ' ');
  return core::write_file(path, core::bytes_of(text + "\n"));
}

Result<void> write_certificate(const fs::path& folder, const Certificate& certificate) {
  Json json = certificate.to_json();
  json["salt"] = core::hex(core::random_bytes(32));
  return write_padded(folder / kCertificatePart, json, kCertificate_bytes);
}

/// Zeros after the salt bring pictures of much the same size to the same.
Result<void> write_picture(const fs::path& folder, const NewCase& made) {
  const fs::path path = folder / kPicturePart;
  TRY(made.draw(path));
  const auto bytes = TRY(core::read_file(path));
  std::string salt = core::hex(core::random_bytes(32));
  const std::size_t least = bytes.size() + kSaltChunk_bytes + salt.size();
  salt.append((kPictureStep_bytes - least % kPictureStep_bytes) % kPictureStep_bytes, '0');
  const auto salted = TRY(salted_png(bytes, salt));
  return core::write_file(path, salted);
}

Result<std::vector<Part>> write_parts(const fs::path& folder, const NewCase& made,
                                      const core::Progress& progress) {
  TRY(volume::write_volume(folder / kVolumePart, made.volume, made.meta, progress));
  TRY(write_padded(folder / kTruthPart, made.truth.to_json(), kTruth_bytes));
  std::vector<std::pair<const char*, bool>> names{{kVolumePart, false}, {kTruthPart, true}};
  if (made.draw) {
    TRY(write_picture(folder, made));
    names.emplace_back(kPicturePart, true);
  }
  if (made.certificate) {
    TRY(write_certificate(folder, *made.certificate));
    names.emplace_back(kCertificatePart, true);
  }
  std::vector<Part> parts;
  for (const auto& [name, secret] : names) {
    auto part = TRY(measured(folder / name, secret));
    parts.push_back(std::move(part));
  }
  return parts;
}

/// A secret part that is JSON, checked against the manifest.
Result<Json> read_secret(const OpenedCase& opened, const char* name) {
  const fs::path path = opened.folder / name;
  const auto bytes = TRY(core::read_file(path, kMaxManifest_bytes));
  const auto& parts = opened.definition.parts;
  const auto part = std::ranges::find(parts, name, &Part::name);
  if (part == parts.end() || part->sha256 != core::sha256(bytes))
    return corrupt(path, "its content is not what the case says (SHA-256)");
  return core::parse_json(core::text_of(bytes), path.string());
}

}  // namespace

Result<OpenedCase> write_case(const fs::path& folder, NewCase made, const core::KeyPair& key,
                              const core::Progress& progress) {
  if (std::error_code failure; fs::exists(folder, failure))
    return Error{Errc::conflict, fmt::format("{}: exists already; remove it or choose another name",
                                             folder.string())};
  auto scratch = TRY(core::ScratchFolder::make(folder));
  made.truth.salt_hex = core::hex(core::random_bytes(32));
  if (made.certificate) made.definition.certified = made.certificate->passes();
  auto parts = TRY(write_parts(scratch.path(), made, progress));
  made.definition.parts = std::move(parts);
  const std::string manifest = made.definition.to_json().dump(2) + "\n";
  TRY(core::write_file(scratch.path() / kManifest, core::bytes_of(manifest)));
  TRY(write_signature(scratch.path() / kSignature, core::bytes_of(manifest), key));
  TRY(open_case(scratch.path()));
  if (progress && !progress(1.0)) return Error{Errc::cancelled, "writing the case was stopped"};
  TRY(scratch.keep_as(folder));
  return OpenedCase{core::sha256(core::bytes_of(manifest)), std::move(made.definition),
                    key.public_hex, folder};
}

Result<OpenedCase> open_case(const fs::path& folder) {
  const fs::path path = folder / kManifest;
  auto bytes = TRY(core::read_file(path, kMaxManifest_bytes));
  auto signer = TRY(checked_signature(folder, bytes));
  auto json = TRY(core::parse_json(core::text_of(bytes), path.string()));
  auto definition = TRY(Case::from_json(json, path.string() + ": "));
  for (const Part& part : definition.parts) TRY(check_part(folder, part));
  TRY(check_nothing_else(folder, definition.parts));
  return OpenedCase{core::sha256(bytes), std::move(definition), std::move(signer), folder};
}

Result<Truth> read_truth(const OpenedCase& opened) {
  const auto json = TRY(read_secret(opened, kTruthPart));
  return Truth::from_json(json, (opened.folder / kTruthPart).string() + ": ");
}

Result<Json> read_certificate(const OpenedCase& opened) {
  return read_secret(opened, kCertificatePart);
}

}  // namespace cases
}  // namespace tractus
