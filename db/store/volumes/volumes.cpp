#include "db/store/volumes/volumes.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kVolume =
    "select id, name, source, state, sha256, size_bytes, facts, report, made_utc_us, made_by, "
    "made_by_id, decided_utc_us, decided_by, reason from volumes ";

core::Result<VolumeRecord> volume_from(const Row& row) {
  VolumeRecord out;
  out.id = row.text(0);
  out.name = row.text(1);
  out.source = row.text(2);
  out.state = TRY(row.word<VolumeState>(3, "volumes.state"));
  out.sha256 = row.text_or_null(4).value_or("");
  out.size_bytes = row.count(5);
  out.facts = row.text(6);
  out.report = row.text(7);
  out.made_utc_us = row.integer(8);
  out.made_by = row.text(9);
  out.made_by_id = row.text(10);
  if (!std::holds_alternative<std::monostate>(row.value(11))) out.decided_utc_us = row.integer(11);
  out.decided_by = row.text_or_null(12);
  out.reason = row.text(13);
  return out;
}

/// Does anything of ours still name the object? Its own table says by foreign keys: the deletion of
/// its row is tried last, so the question is asked of every table that may.
core::Result<bool> is_named(Reading& tx, const std::string& sha256) {
  auto rows =
      TRY(tx.query("select (select count(*) from volumes where sha256 = ?) + "
                   "(select count(*) from case_parts where sha256 = ?) + "
                   "(select count(*) from trials where sha256 = ?)",
                   {sha256, sha256, sha256}));
  return rows.front().integer(0) > 0;
}

}  // namespace

core::Result<void> add_volume(Writing& tx, const VolumeRecord& v) {
  auto twin = TRY(tx.query("select id, name from volumes where sha256 = ?", {v.sha256}));
  if (!twin.empty())
    return core::Error{core::Errc::conflict, "these voxels are already on this server, as volume " +
                                                 twin.front().text(0) + " \"" +
                                                 twin.front().text(1) + "\""};
  TRY(
      tx.query("insert into volumes (id, name, source, state, sha256, size_bytes, facts, report, "
               "made_utc_us, made_by, made_by_id) values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
               {v.id, v.name, v.source, name_value(v.state), v.sha256, count_value(v.size_bytes),
                v.facts, v.report, v.made_utc_us, v.made_by, v.made_by_id}));
  return {};
}

core::Result<std::optional<VolumeRecord>> volume_of(Reading& tx, const std::string& id) {
  return one_of(tx.query(std::string(kVolume) + "where id = ?", {id}), volume_from);
}

core::Result<std::vector<VolumeRecord>> all_volumes(Reading& tx) {
  return all_of(tx.query(std::string(kVolume) + "order by made_utc_us desc, id", {}), volume_from);
}

core::Result<std::string> decide_volume(Writing& tx, const std::string& id,
                                        const Decision& decision) {
  auto known = TRY(volume_of(tx, id));
  if (!known) return core::Error{core::Errc::not_found, "there is no volume " + id.substr(0, 64)};
  if (known->state != VolumeState::held)
    return core::Error{core::Errc::conflict, "volume " + id + " was " +
                                                 std::string(core::name(known->state)) +
                                                 " already, by " + known->decided_by.value_or("")};
  const std::string sha256 = known->sha256;
  const bool refused = decision.state == VolumeState::refused;
  TRY(tx.query(
      "update volumes set state = ?, sha256 = ?, decided_utc_us = ?, decided_by = ?, reason = ? "
      "where id = ?",
      {name_value(decision.state), refused ? Value() : Value(sha256), decision.at_utc_us,
       decision.by, decision.reason, id}));
  if (!refused) return std::string();
  auto named = TRY(is_named(tx, sha256));
  if (named) return std::string();
  TRY(tx.query("delete from objects where sha256 = ?", {sha256}));
  return sha256;
}

}  // namespace store
}  // namespace tractus
