/** The rule from the identity provider's groups to roles and cohorts. */
import { queryOptions } from '@tanstack/react-query';
import * as v from 'valibot';
import { address } from './address';
import { requestJson } from './client';
import { count, inUtc } from './quantities';

const lineSchema = v.object({
  group: v.string(),
  role: v.string(),
  cohorts: v.optional(v.array(v.string()), []),
  level: v.optional(v.string(), ''),
});
export type GroupLine = v.InferOutput<typeof lineSchema>;

export const groupRulesSchema = v.object({
  versions: v.array(
    v.object({
      version: count,
      rule: v.object({
        format: v.string(),
        lines: v.array(lineSchema),
        absent_days: v.optional(count),
      }),
      reason: v.string(),
      made_utc_us: inUtc,
      made_by: v.string(),
    }),
  ),
});

/** Roles that a group may give: administrators are made by hand. */
export const kGroupRoles = ['trainee', 'faculty', 'director', 'researcher', 'technician'] as const;

export const groupRulesQuery = queryOptions({
  queryKey: ['group-rules'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/group-rules', {}), groupRulesSchema, { signal }),
});
export const setGroupRule = ({
  lines,
  absent_days,
  reason,
}: {
  readonly lines: readonly GroupLine[];
  readonly absent_days: number | null;
  readonly reason: string;
}) =>
  requestJson(address('/api/v1/group-rules', {}), groupRulesSchema, {
    method: 'POST',
    body: {
      rule: { format: 'tractus-groups/1', lines, ...(absent_days === null ? {} : { absent_days }) },
      reason,
    },
  });
