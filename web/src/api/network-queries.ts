/** Accounts, stations, cohorts and the audit trail: what can be asked, and what can be decided. */
import { keepPreviousData, queryOptions } from '@tanstack/react-query';
import { address } from './address';
import { requestJson, request } from './client';
import { everyRow, kMostRows, kRowsPerPage, type AccountsAsked, type AuditAsked } from './lists';
import {
  accountListSchema,
  accountSchema,
  auditCheckSchema,
  auditSchema,
  codesSchema,
  cohortListSchema,
  cohortSchema,
  enrolmentSchema,
  invitationListSchema,
  newAccountSchema,
  newPasswordSchema,
  stationListSchema,
  type Role,
} from './network-schemas';

const kStations_ms = 15_000;

const accounts = (asked: AccountsAsked, limit: number, signal: AbortSignal) =>
  requestJson(address('/api/v1/accounts', {}, { ...asked, limit }), accountListSchema, { signal });
/** A page of the accounts. */
export const accountsQuery = (asked: AccountsAsked) =>
  queryOptions({
    queryKey: ['accounts', 'page', asked],
    queryFn: ({ signal }) => accounts(asked, kRowsPerPage, signal),
    placeholderData: keepPreviousData,
  });
/** All accounts, by name. Its key begins those of the pages. */
export const allAccountsQuery = queryOptions({
  queryKey: ['accounts'],
  queryFn: async ({ signal }) => ({
    accounts: await everyRow(async (cursor) => {
      const { accounts: rows, next } = await accounts({ cursor }, kMostRows, signal);
      return { rows, next };
    }),
  }),
});
export const stationsQuery = queryOptions({
  queryKey: ['stations'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/stations', {}), stationListSchema, { signal }),
  refetchInterval: kStations_ms,
});
export const cohortsQuery = queryOptions({
  queryKey: ['cohorts'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/cohorts', {}), cohortListSchema, { signal }),
});
export const cohortQuery = (id: string) =>
  queryOptions({
    queryKey: ['cohorts', id],
    queryFn: ({ signal }) => requestJson(address('/api/v1/cohorts/{id}', { id }), cohortSchema, { signal }),
  });

export const invitationsQuery = queryOptions({
  queryKey: ['invitations'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/session/invitations', {}), invitationListSchema, { signal }),
});

export const auditQuery = (asked: AuditAsked) =>
  queryOptions({
    queryKey: ['audit', asked],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/audit', {}, { ...asked, limit: kRowsPerPage }), auditSchema, { signal }),
    placeholderData: keepPreviousData,
  });
export const checkAudit = () => requestJson(address('/api/v1/audit/check', {}), auditCheckSchema);

export interface NewAccount {
  readonly name: string;
  readonly role: Role;
  readonly badge?: string;
  readonly pin?: string;
}

const posted = { method: 'POST' } as const;
export const addAccount = (account: NewAccount) =>
  requestJson(address('/api/v1/accounts', {}), newAccountSchema, { ...posted, body: account });
export const setAccountState = (id: string, state: 'active' | 'disabled') =>
  requestJson(address('/api/v1/accounts/{id}/state', { id }), accountSchema, { ...posted, body: { state } });
export const setAccountRole = (id: string, role: Role) =>
  requestJson(address('/api/v1/accounts/{id}/role', { id }), accountSchema, { ...posted, body: { role } });
export const resetPassword = (id: string) =>
  requestJson(address('/api/v1/accounts/{id}/password', { id }), newPasswordSchema, posted);
export const setBadge = (id: string, badge: string, pin: string) =>
  requestJson(address('/api/v1/accounts/{id}/badge', { id }), accountSchema, {
    ...posted,
    body: { ...(badge === '' ? {} : { badge }), ...(pin === '' ? {} : { pin }) },
  });

export const enrolStation = (name: string) =>
  requestJson(address('/api/v1/stations/codes', {}), enrolmentSchema, { ...posted, body: { name } });
export const revokeStation = (id: string) => request(address('/api/v1/stations/{id}/revoke', { id }), posted);

export const addCohort = (name: string) =>
  requestJson(address('/api/v1/cohorts', {}), cohortSchema, { ...posted, body: { name } });
export const addToCohort = (id: string, name: string) =>
  requestJson(address('/api/v1/cohorts/{id}/people', { id }), cohortSchema, { ...posted, body: { name } });
export const removeFromCohort = (id: string, account: string) =>
  requestJson(address('/api/v1/cohorts/{id}/people/{account_id}', { id, account_id: account }), cohortSchema, {
    method: 'DELETE',
  });
export const inviteIntoCohort = (id: string, name: string) =>
  requestJson(address('/api/v1/cohorts/{id}/invitations', { id }), cohortSchema, { ...posted, body: { name } });
export const withdrawInvitation = (id: string, name: string) =>
  requestJson(address('/api/v1/cohorts/{id}/invitations/{name}', { id, name }), cohortSchema, { method: 'DELETE' });
export const acceptInvitation = (cohort: string) =>
  requestJson(address('/api/v1/session/invitations/{cohort}/accept', { cohort }), invitationListSchema, posted);
export const declineInvitation = (cohort: string) =>
  requestJson(address('/api/v1/session/invitations/{cohort}/decline', { cohort }), invitationListSchema, posted);

/** @param code one-time, where the account asks for codes */
export const changePassword = (old: string, next: string, code?: string) =>
  request(address('/api/v1/session/password', {}), {
    ...posted,
    body: { old, new: next, ...(code === undefined ? {} : { code }) },
  });
export const beginCodes = (password: string) =>
  requestJson(address('/api/v1/session/codes', {}), codesSchema, { ...posted, body: { password } });
export const confirmCodes = (code: string) =>
  request(address('/api/v1/session/codes/confirm', {}), { ...posted, body: { code } });
export const endCodes = (password: string, code: string) =>
  request(address('/api/v1/session/codes/end', {}), { ...posted, body: { password, code } });
