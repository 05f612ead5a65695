#include "db/store/people/api_tokens.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kToken =
    "select t.id, t.account_id, t.name, t.scopes, t.made_utc_us, t.expires_utc_us, "
    "t.revoked_utc_us, t.revoked_by, u.used_utc_us, a.name from api_tokens t join accounts a on "
    "a.id = t.account_id left join api_token_uses u on u.token_id = t.id ";

std::string scopes_text(const std::vector<TokenScope>& scopes) {
  std::vector<std::string_view> out;
  for (const TokenScope scope : scopes) out.push_back(name(scope));
  return fmt::format("{}", fmt::join(out, " "));
}

core::Result<std::vector<TokenScope>> scopes_from(std::string_view text) {
  std::vector<TokenScope> out;
  while (!text.empty()) {
    const auto end = std::min(text.find(' '), text.size());
    const auto scope = core::from_name<TokenScope>(text.substr(0, end));
    if (!scope)
      return core::Error{core::Errc::corrupt,
                         "api_tokens.scopes: no scope " + std::string(text.substr(0, end))};
    out.push_back(*scope);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::optional<std::int64_t> time_or_none(const Row& row, std::size_t column) {
  const auto* at = std::get_if<std::int64_t>(&row.value(column));
  return at ? std::optional(*at) : std::nullopt;
}

core::Result<ApiToken> token_from(const Row& row) {
  auto scopes = TRY(scopes_from(row.text(3)));
  return ApiToken{.id = row.text(0),
                  .account_id = row.text(1),
                  .name = row.text(2),
                  .scopes = std::move(scopes),
                  .made_utc_us = row.integer(4),
                  .expires_utc_us = row.integer(5),
                  .revoked_utc_us = time_or_none(row, 6),
                  .revoked_by = row.text(7),
                  .used_utc_us = time_or_none(row, 8),
                  .owner = row.text(9)};
}

}  // namespace

bool is_valid(const ApiToken& token, std::int64_t now_utc_us) {
  return !token.revoked_utc_us && now_utc_us < token.expires_utc_us;
}

core::Result<void> add_api_token(Writing& tx, const ApiToken& token, const std::string& hash) {
  const auto rows =
      TRY(tx.query("select count(*) from api_tokens where account_id = ? and revoked_utc_us is "
                   "null and expires_utc_us > ?",
                   {token.account_id, token.made_utc_us}));
  if (rows.front().integer(0) >= kMaxApiTokens)
    return core::Error{
        core::Errc::conflict,
        fmt::format("there are {} valid tokens already: revoke one first", kMaxApiTokens)};
  return done(
      tx.query("insert into api_tokens (id, account_id, name, token_hash, scopes, made_utc_us, "
               "expires_utc_us) values (?, ?, ?, ?, ?, ?, ?)",
               {token.id, token.account_id, token.name, hash, scopes_text(token.scopes),
                token.made_utc_us, token.expires_utc_us}));
}

core::Result<std::vector<ApiToken>> api_tokens_of(Reading& tx, const std::string& account_id) {
  return all_of(tx.query(std::string(kToken) +
                             "where t.account_id = ? order by t.made_utc_us desc, t.id limit 200",
                         {account_id}),
                token_from);
}

core::Result<std::vector<ApiToken>> valid_api_tokens(Reading& tx, std::int64_t now_utc_us) {
  return all_of(tx.query(std::string(kToken) +
                             "where t.revoked_utc_us is null and t.expires_utc_us > ? order by "
                             "a.name, t.made_utc_us desc, t.id",
                         {now_utc_us}),
                token_from);
}

core::Result<std::optional<ApiToken>> api_token_with(Reading& tx, const std::string& hash) {
  return one_of(tx.query(std::string(kToken) + "where t.token_hash = ?", {hash}), token_from);
}

core::Result<bool> owns_api_token(Reading& tx, const std::string& account_id,
                                  const std::string& id) {
  const auto rows =
      TRY(tx.query("select 1 from api_tokens where id = ? and account_id = ?", {id, account_id}));
  return !rows.empty();
}

core::Result<void> note_api_token_use(Writing& tx, const std::string& id, std::int64_t now_utc_us) {
  return done(tx.query(
      "insert into api_token_uses (token_id, used_utc_us) values (?, ?) on conflict (token_id) do "
      "update set used_utc_us = excluded.used_utc_us",
      {id, now_utc_us}));
}

core::Result<void> revoke_api_token(Writing& tx, const std::string& id, const TokenEnd& end) {
  const auto known = TRY(tx.query("select 1 from api_tokens where id = ?", {id}));
  if (known.empty()) return core::Error{core::Errc::not_found, "no API token " + id.substr(0, 32)};
  return done(tx.query(
      "update api_tokens set revoked_utc_us = ?, revoked_by = ? where id = ? and revoked_utc_us is "
      "null",
      {end.at_utc_us, end.by, id}));
}

core::Result<void> revoke_api_tokens_of(Writing& tx, const std::string& account_id,
                                        const TokenEnd& end) {
  return done(
      tx.query("update api_tokens set revoked_utc_us = ?, revoked_by = ? where account_id = ? and "
               "revoked_utc_us is null",
               {end.at_utc_us, end.by, account_id}));
}

core::Result<void> limit_api_tokens_of(Writing& tx, const std::string& account_id,
                                       const std::vector<TokenScope>& allowed,
                                       const TokenEnd& end) {
  const auto tokens = TRY(
      all_of(tx.query(std::string(kToken) + "where t.account_id = ? and t.revoked_utc_us is null",
                      {account_id}),
             token_from));
  for (const ApiToken& token : tokens) {
    std::vector<TokenScope> kept = token.scopes;
    std::erase_if(kept, [&](TokenScope one) { return std::ranges::count(allowed, one) == 0; });
    if (kept.empty()) {
      TRY(revoke_api_token(tx, token.id, end));
    } else if (kept != token.scopes) {
      TRY(tx.query("update api_tokens set scopes = ? where id = ?", {scopes_text(kept), token.id}));
    }
  }
  return {};
}

}  // namespace store
}  // namespace tractus
