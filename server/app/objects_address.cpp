#include "server/app/objects_address.hpp"

#include <fmt/format.h>

#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/volumes/s3_store.hpp"
#include "server/api/web_fetch.hpp"
#include "server/app/database.hpp"

namespace tractus {
namespace app {
namespace fs = std::filesystem;
namespace {

core::Result<std::unique_ptr<store::ObjectStore>> opened_store(const std::string& address) {
  if (!api::is_safe_address(address))  // it is not repeated: it may hold credentials
    return core::bad_input(
        "--objects: https://HOST[:PORT]/BUCKET[/PREFIX][?region=REGION] is expected, without "
        "credentials");
  auto parsed = TRY(store::S3Address::parse(address));
  return store::open_s3(std::move(parsed), TRY(store::S3Credentials::find()));
}

/// Empty: in the folder.
core::Result<std::string> noted_place(const fs::path& folder) {
  std::error_code failure;
  if (!fs::exists(folder / kObjectsFile, failure) && !failure) return std::string();
  const auto bytes = TRY(core::read_file(folder / kObjectsFile, 4096));
  const std::string text(core::text_of(bytes));
  return text.substr(0, text.find_first_of("\r\n"));
}

/// What is wrong with credentials, bucket or rights shows now, and not when the first trial comes.
core::Result<void> try_out(const store::ObjectStore& store, const fs::path& folder) {
  const fs::path probe = folder / "objects.probe.part";
  const core::Bytes bytes = core::random_bytes(32);
  const std::string sha256 = core::sha256(bytes);
  TRY(core::write_file(probe, bytes));
  const auto put = store.put(sha256, probe);
  std::error_code ignored;
  fs::remove(probe, ignored);
  if (!put) return put;
  if (TRY(store.size_of(sha256)) != bytes.size())
    return core::Error{core::Errc::unavailable, "object store: lost an object that it had taken"};
  return store.remove(sha256);
}

}  // namespace

core::Result<store::Objects> open_objects(const fs::path& folder) {
  const std::string address = TRY(noted_place(folder));
  if (address.empty()) return store::Objects::open(folder);
  auto beyond = opened_store(address);
  if (!beyond)
    return core::Error{beyond.error().code, fmt::format("{}: {}", (folder / kObjectsFile).string(),
                                                        beyond.error().what)};
  return store::Objects::open(folder, std::move(*beyond));
}

core::Result<void> keep_objects_at(const fs::path& folder, const std::string& address) {
  if (address.empty()) return {};
  const std::string noted = TRY(noted_place(folder));
  if (noted == address) return {};
  std::error_code failure;
  const bool furnished =
      fs::exists(folder / kDatabase, failure) || fs::exists(folder / kAddressFile, failure);
  if (!noted.empty() || furnished)
    return core::Error{
        core::Errc::conflict,
        fmt::format("{}: the objects of this folder are kept {}; to move them: backup, then "
                    "restore --objects",
                    folder.string(), noted.empty() ? "in it" : "at " + noted)};
  const auto store = TRY(opened_store(address));
  fs::create_directories(folder, failure);
  if (failure)
    return core::Error{core::Errc::io,
                       fmt::format("{}: cannot create: {}", folder.string(), failure.message())};
  if (auto tried = try_out(*store, folder); !tried)
    return core::Error{tried.error().code,
                       fmt::format("--objects {}: {}", address, tried.error().what)};
  return core::write_file(folder / kObjectsFile, core::bytes_of(address + "\n"));
}

}  // namespace app
}  // namespace tractus
