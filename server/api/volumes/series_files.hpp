/// The DICOM files of a series, as DICOMweb sends them: parts of one body (PS3.18, section 8.6.1.2).
#pragma once

#include <filesystem>
#include <memory>

#include "server/http/multipart.hpp"

namespace tractus::api {

/// The most that one series may have.
struct SeriesLimits {
  std::uint64_t bytes = 1ull << 30;
  std::size_t files = 4096;
};

/// DICOM files of a body of several parts, written into a folder as 000001.dcm, 000002.dcm …
class SeriesFiles {
 public:
  /// @param who  "the PACS at …", for messages. Errors: bad_input if the content type is not
  /// multipart/related with a boundary.
  static core::Result<std::unique_ptr<SeriesFiles>> make(std::string_view content_type,
                                                         std::filesystem::path folder,
                                                         std::string who, SeriesLimits limits = {});
  ~SeriesFiles();
  SeriesFiles(const SeriesFiles&) = delete;
  SeriesFiles& operator=(const SeriesFiles&) = delete;

  /// Errors: too_large; bad_input if a part is not of type application/dicom; io.
  core::Result<void> take(std::string_view piece);
  /// Errors: bad_input if the body is not whole or has no file.
  core::Result<void> finish() const;
  std::size_t files() const { return files_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  SeriesFiles(std::string_view boundary, std::filesystem::path folder, std::string who,
              SeriesLimits limits);
  core::Result<void> begin(const std::string& type);
  core::Result<void> write(std::string_view bytes) const;
  core::Result<void> end();

  const std::filesystem::path folder_;
  const std::string who_;
  const SeriesLimits limits_;
  std::size_t files_ = 0;
  std::uint64_t bytes_ = 0;
  int fd_ = -1;
  http::Multipart parts_;
};

}  // namespace tractus::api
