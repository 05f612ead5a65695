#include "server/api/volumes/series_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "core/file.hpp"
#include "core/try.hpp"
#include "core/words.hpp"

namespace tractus {
namespace api {

using core::bad_input;
using core::Errc;
using core::Error;
using core::Result;

Result<std::unique_ptr<SeriesFiles>> SeriesFiles::make(std::string_view content_type,
                                                       std::filesystem::path folder,
                                                       std::string who, SeriesLimits limits) {
  const http::MediaType media = http::media_type_of(content_type);
  if (media.type != "multipart/related")
    return bad_input(fmt::format("{} sent the type \"{}\": multipart/related is expected", who,
                                 core::one_line(media.type, 60)));
  if (media.boundary.empty() || media.boundary.size() > http::Multipart::kMaxBoundary)
    return bad_input(who + " sent multipart/related without a boundary");
  return std::unique_ptr<SeriesFiles>(
      new SeriesFiles(media.boundary, std::move(folder), std::move(who), limits));
}

SeriesFiles::SeriesFiles(std::string_view boundary, std::filesystem::path folder, std::string who,
                         SeriesLimits limits)
    : folder_(std::move(folder)),
      who_(std::move(who)),
      limits_(limits),
      parts_(boundary, who_,
             {.begin = [this](const std::string& type) { return begin(type); },
              .bytes = [this](std::string_view bytes) { return write(bytes); },
              .end = [this] { return end(); }}) {}

SeriesFiles::~SeriesFiles() {
  if (fd_ >= 0) ::close(fd_);
}

Result<void> SeriesFiles::take(std::string_view piece) {
  bytes_ += piece.size();
  if (bytes_ > limits_.bytes)
    return Error{Errc::too_large,
                 fmt::format("{} sent more than {} MiB", who_, limits_.bytes >> 20)};
  return parts_.take(piece);
}

Result<void> SeriesFiles::finish() const {
  TRY(parts_.finish());
  if (files_ == 0) return bad_input(who_ + " sent no file");
  return {};
}

Result<void> SeriesFiles::begin(const std::string& type) {
  if (type != "application/dicom")
    return bad_input(fmt::format("{} sent a part of the type \"{}\": application/dicom is expected",
                                 who_, core::one_line(type, 60)));
  if (files_ >= limits_.files)
    return Error{Errc::too_large, fmt::format("{} sent more than {} files", who_, limits_.files)};
  const auto path = folder_ / fmt::format("{:06}.dcm", files_ + 1);
  fd_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (fd_ < 0) return core::system_error("a file of the series", "cannot be made");
  ++files_;
  return {};
}

Result<void> SeriesFiles::write(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return core::system_error("a file of the series", "cannot be written");
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return {};
}

Result<void> SeriesFiles::end() {
  if (::close(std::exchange(fd_, -1)) == 0) return {};
  return core::system_error("a file of the series", "cannot be written");
}

}  // namespace api
}  // namespace tractus
