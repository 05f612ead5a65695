/// Personal API tokens: a person's programs call the server with them, within scopes, until a date.
#pragma once

#include <vector>

#include "db/store/people/accounts.hpp"
#include "db/store/people/token_scope.hpp"

namespace tractus::store {

struct ApiToken {
  std::string id, account_id;
  std::string name;  ///< given by its owner
  std::vector<TokenScope> scopes;
  std::int64_t made_utc_us = 0;
  std::int64_t expires_utc_us = 0;
  std::optional<std::int64_t> revoked_utc_us = {};
  std::string revoked_by = {};                   ///< name of the account; empty: not revoked
  std::optional<std::int64_t> used_utc_us = {};  ///< time of the last use, to the minute
  std::string owner = {};                        ///< name of the account; filled on reading
};
/// Whether the token is neither revoked nor expired.
bool is_valid(const ApiToken& token, std::int64_t now_utc_us);

/// Valid tokens of one account, at most.
inline constexpr std::int64_t kMaxApiTokens = 20;

/// @param hash  SHA-256 of the token that its owner holds. Errors: conflict if the account has
/// kMaxApiTokens valid tokens.
core::Result<void> add_api_token(Writing& tx, const ApiToken& token, const std::string& hash);
/// Of one account, newest first, also those that have ended.
core::Result<std::vector<ApiToken>> api_tokens_of(Reading& tx, const std::string& account_id);
/// Valid tokens of all accounts, by owner, then newest first.
core::Result<std::vector<ApiToken>> valid_api_tokens(Reading& tx, std::int64_t now_utc_us);
/// Also a token that has ended.
core::Result<std::optional<ApiToken>> api_token_with(Reading& tx, const std::string& hash);
core::Result<bool> owns_api_token(Reading& tx, const std::string& account_id,
                                  const std::string& id);
/// Correct in Store::write_beside.
core::Result<void> note_api_token_use(Writing& tx, const std::string& id, std::int64_t now_utc_us);

/// Who ended a token, and when.
struct TokenEnd {
  std::string by;
  std::int64_t at_utc_us = 0;
};
/// A token that was revoked before keeps its first end. Errors: not_found.
core::Result<void> revoke_api_token(Writing& tx, const std::string& id, const TokenEnd& end);
core::Result<void> revoke_api_tokens_of(Writing& tx, const std::string& account_id,
                                        const TokenEnd& end);
/// Removes all other scopes from the account's tokens; a token without scopes is revoked.
core::Result<void> limit_api_tokens_of(Writing& tx, const std::string& account_id,
                                       const std::vector<TokenScope>& allowed, const TokenEnd& end);

}  // namespace tractus::store
