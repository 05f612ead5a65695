/// Anchors: the end of the audit trail, noted outside the database under a MAC (ADR-0028).
///
/// DATA/audit.anchor has a line for each: "ROW HASH COUNT UTC_US MAC", COUNT from 1 without gaps.
/// Lines "ROW HASH" are from before there were MACs. DATA/audit.highwater has the newest anchor
/// under a MAC of its own, so that it cannot be made of a line of audit.anchor.
#pragma once

#include <optional>
#include <vector>

#include "core/progress.hpp"
#include "db/store/operations/backup.hpp"
#include "server/app/data_folder.hpp"

namespace tractus::app {

inline constexpr const char* kAnchors = "audit.anchor";
inline constexpr const char* kHighWater = "audit.highwater";

struct Anchor {
  store::ChainEnd end;
  std::int64_t count = 0;  ///< 0: from before there were MACs
  std::int64_t at_utc_us = 0;
  std::string mac = {};
  /// As in audit.anchor, without the line's end.
  std::string line() const;
};

/// What anchors say, and what is wrong with them.
struct AnchorReport {
  store::Anchors ends;
  std::vector<std::string> findings;
  std::int64_t newest_utc_us = 0;
  std::int64_t anchors = 0;  ///< with a MAC
  bool has_high_water = false;
};
/// Reads a folder's anchors, and a copy of them from elsewhere if there is one. Lines of the copy
/// may have other words before the anchor. Errors: io; not_found and bad_input for the copy.
core::Result<AnchorReport> check_anchors(const std::filesystem::path& data,
                                         const store::AuditKey& key,
                                         const std::optional<std::filesystem::path>& copy = {});

/// Notes the trail's present end when it is a new one, and returns that anchor. Errors: io; corrupt
/// when anchors are missing or changed, or the trail lacks a row that was noted: nothing is written
/// then, so that it stays visible.
core::Result<std::optional<Anchor>> note_anchor(DataFolder& data);
/// The newest anchor with a MAC; nothing when there is none or it does not hold.
std::optional<Anchor> newest_anchor(const DataFolder& data);
/// Puts anchors that do not hold aside (audit.anchor.UTC) and begins again with the present end.
core::Result<void> begin_anchors_again(DataFolder& data);

/// Anchors what is there, then begins to cover rows by the trail (store::begin_coverage); once, at
/// the first start under this scheme. Says so in the log.
core::Result<void> begin_trail(DataFolder& data);

/// store::look_over with the folder's anchors.
struct Examined {
  store::Findings found;
  AnchorReport anchors;
};
core::Result<Examined> examine(DataFolder& data, const core::Progress& shown,
                               const std::optional<std::filesystem::path>& copy = {});

}  // namespace tractus::app
