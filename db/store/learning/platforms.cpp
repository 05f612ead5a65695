#include "db/store/learning/platforms.hpp"

#include <fmt/format.h>

#include "core/json.hpp"
#include "core/try.hpp"
#include "db/store/operations/deliveries.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kPlatform =
    "select id, issuer, client_id, deployments, authorization_url, token_url, keys_url, "
    "match_email, made_utc_us, made_by from lti_platforms ";

core::Result<Platform> platform_from(const Row& row) {
  Platform out{.id = row.text(0),
               .issuer = row.text(1),
               .client_id = row.text(2),
               .deployments = {},
               .authorization_url = row.text(4),
               .token_url = row.text(5),
               .keys_url = row.text(6),
               .match_email = row.truth(7),
               .made_utc_us = row.integer(8),
               .made_by = row.text(9)};
  for (const core::Json& one : core::stored_json(row.text(3)))
    if (one.is_string()) out.deployments.push_back(one.get<std::string>());
  return out;
}

core::Result<ToolKeyRow> tool_key_from(const Row& row) {
  return ToolKeyRow{row.text(0), row.text(1), row.text(2), row.integer(3)};
}

}  // namespace

core::Result<void> add_platform(Writing& tx, const Platform& p) {
  const auto rows = TRY(tx.query("select count(*) from lti_platforms"));
  if (rows.front().integer(0) >= kMaxPlatforms)
    return core::Error{core::Errc::conflict,
                       fmt::format("there are {} platforms: remove one first", kMaxPlatforms)};
  const auto added = done(tx.query(
      "insert into lti_platforms (id, issuer, client_id, deployments, authorization_url, "
      "token_url, keys_url, match_email, made_utc_us, made_by) values (?, ?, ?, ?, ?, ?, ?, ?, ?, "
      "?)",
      {p.id, p.issuer, p.client_id, core::Json(p.deployments).dump(), p.authorization_url,
       p.token_url, p.keys_url, bool_value(p.match_email), p.made_utc_us, p.made_by}));
  if (!added && added.error().code == core::Errc::conflict)
    return core::Error{core::Errc::conflict,
                       "there is a platform with this issuer and client_id already"};
  return added;
}

core::Result<std::vector<Platform>> all_platforms(Reading& tx) {
  return all_of(tx.query(std::string(kPlatform) + "order by issuer, client_id"), platform_from);
}

core::Result<std::optional<Platform>> platform_of(Reading& tx, const std::string& id) {
  return one_of(tx.query(std::string(kPlatform) + "where id = ?", {id}), platform_from);
}

core::Result<void> remove_platform(Writing& tx, const std::string& id,
                                   const std::string& kept_issuer, std::int64_t now_utc_us) {
  const auto found = TRY(platform_of(tx, id));
  if (!found) return core::Error{core::Errc::not_found, "no platform " + id.substr(0, 32)};
  TRY(tx.query("delete from lti_line_items where platform_id = ?", {id}));
  TRY(tx.query("delete from lti_platforms where id = ?", {id}));
  TRY(withdraw_deliveries(tx, Channel::lti, id, now_utc_us));
  return done(
      tx.query("delete from oidc_subjects where issuer = ? and issuer <> ? and not exists (select "
               "1 from lti_platforms p where p.issuer = oidc_subjects.issuer)",
               {found->issuer, kept_issuer}));
}

core::Result<void> use_nonce(Writing& tx, const std::string& nonce, std::int64_t until_utc_us,
                             std::int64_t now_utc_us) {
  TRY(tx.query("delete from lti_nonces where until_utc_us < ?", {now_utc_us}));
  const auto rows = TRY(
      tx.query("insert into lti_nonces (nonce, until_utc_us) values (?, ?) on conflict (nonce) do "
               "nothing returning nonce",
               {nonce, until_utc_us}));
  if (rows.empty())
    return core::Error{core::Errc::unauthorised, "this launch was used before (nonce)"};
  return {};
}

core::Result<std::optional<ToolKeyRow>> tool_key_row(Reading& tx) {
  return one_of(tx.query("select kid, private_key, public_key, made_utc_us from lti_keys order by "
                         "made_utc_us, kid limit 1"),
                tool_key_from);
}

core::Result<void> add_tool_key(Writing& tx, const ToolKeyRow& key) {
  return done(tx.query(
      "insert into lti_keys (kid, private_key, public_key, made_utc_us) values (?, ?, ?, ?)",
      {key.kid, key.private_key, key.public_key, key.made_utc_us}));
}

core::Result<std::string> trainee_with_address(Reading& tx, const std::string& address) {
  const auto rows = TRY(
      tx.query("select a.id, a.role from accounts a join notification_addresses n on n.account_id "
               "= a.id where a.state = 'active' and lower(n.address) = lower(?) limit 2",
               {address}));
  const bool one = rows.size() == 1 && rows.front().text(1) == core::name(Role::trainee);
  return one ? rows.front().text(0) : std::string();
}

}  // namespace store
}  // namespace tractus
