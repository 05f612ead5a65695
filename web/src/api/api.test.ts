import { QueryClient } from '@tanstack/react-query';
import { describe, expect, it, vi } from 'vitest';
import * as v from 'valibot';
import { ApiError, sessionQuery, signIn } from '@/api';
import { requestJson, request, withoutPointer } from './client';
import { parsePreview } from './preview';
import { pathSchema, signalsSchema, trialPageSchema, trialSchema } from './schemas';

const json = (body: unknown, status = 200) =>
  new Response(JSON.stringify(body), { status, headers: { 'Content-Type': 'application/json' } });
const served = (answer: Response | Error) =>
  vi
    .spyOn(globalThis, 'fetch')
    .mockImplementation(() => (answer instanceof Error ? Promise.reject(answer) : Promise.resolve(answer)));

async function failure(promise: Promise<unknown>): Promise<ApiError> {
  const reason: unknown = await promise.then(
    () => undefined,
    (error: unknown) => error,
  );
  if (!(reason instanceof ApiError)) throw new Error(`not an ApiError: ${String(reason)}`);
  return reason;
}

describe('asking the server', () => {
  it('marks what changes something, so that another site cannot forge it', async () => {
    const fetch = served(json({ name: 'a', role: 'admin' }));
    await signIn('a', 'b');
    const [address, init] = fetch.mock.calls[0] ?? [];
    expect(address).toBe('/api/v1/session');
    expect(new Headers(init?.headers).get('X-Tractus')).toBe('1');
    expect(init?.credentials).toBe('same-origin');
  });

  it.each([
    [401, 'unauthorised'],
    [403, 'forbidden'],
    [404, 'not_found'],
    [429, 'too_many'],
    [503, 'unavailable'],
    [400, 'refused'],
  ])('turns status %d into %s with the sentence of the server', async (status, code) => {
    served(json({ error: 'one line for a person', code: 'x' }, status));
    const reason = await failure(request('/session', { method: 'DELETE' }));
    expect(reason.code).toBe(code);
    expect(reason.message).toBe('one line for a person');
  });

  it('says that the server is away when there is no answer', async () => {
    served(new TypeError('Failed to fetch'));
    const reason = await failure(requestJson('/trials', trialPageSchema));
    expect(reason.code).toBe('unreachable');
    expect(reason.message).toContain('does not answer');
  });

  it('says so when a proxy answers with a page instead of JSON', async () => {
    served(new Response('<html>', { status: 502 }));
    const reason = await failure(requestJson('/trials', trialPageSchema));
    expect(reason.code).toBe('unavailable');
    expect(reason.message).toContain('502');
  });

  it('names the place in an answer of another shape', async () => {
    served(json({ trials: [{ id: 7 }], more: false }));
    const reason = await failure(requestJson('/trials', trialPageSchema));
    expect(reason.code).toBe('unreadable');
    expect(reason.message).toContain('trials.0.id');
  });

  it('takes a 401 on the session for nobody signed in, not for a failure', async () => {
    served(json({ error: 'Nobody is signed in.', code: 'unauthorised' }, 401));
    await expect(new QueryClient().fetchQuery(sessionQuery)).resolves.toBeNull();
  });
});

describe('an answer', () => {
  it('with columns of different lengths is refused', () => {
    const signals = {
      t_s: [0, 1],
      channels: { depth_m: { min: [0], max: [0] } },
      from_s: 0,
      to_s: 1,
      samples_per_point: 1,
    };
    expect(v.safeParse(signalsSchema, signals).success).toBe(false);
    expect(v.safeParse(pathSchema, { t_s: [0], tip_m: [], force_N: [] }).success).toBe(false);
  });

  it('with gaps in a channel is kept, gaps and all', () => {
    const signals = {
      t_s: [0, 1],
      channels: { depth_m: { min: [0, null], max: [0, null] } },
      from_s: 0,
      to_s: 1,
      samples_per_point: 1,
    };
    expect(v.parse(signalsSchema, signals).channels.depth_m?.min).toEqual([0, null]);
  });

  it('whose coverage is not depth × angle is refused', () => {
    const issues = v.safeParse(trialSchema.entries.coverage, {
      depth_bins: 2,
      angle_bins: 2,
      samples: [1, 2, 3],
    }).issues;
    expect(issues?.[0]?.message).toContain('depth_bins × angle_bins');
  });
});

describe('a preview', () => {
  const headers = (dims: string) =>
    new Headers({
      'X-Dims': dims,
      'X-Spacing-m': '0.001,0.001,0.001',
      'X-Origin-m': '0, 0, 0',
      'X-Directions': '1,0,0,0,1,0,0,0,1',
    });

  it('is read with its place in the patient', () => {
    const block = parsePreview(headers('2,1,2'), new Uint8Array(4));
    expect(block.dims).toEqual([2, 1, 2]);
    expect(block.spacing_m).toEqual([0.001, 0.001, 0.001]);
  });

  it.each(['2,2,2', '2,1', '-2,-1,2', '1e9,1,1', 'a,b,c'])(
    'of size %s that does not fit its four bytes is refused',
    (dims) => {
      expect(() => parsePreview(headers(dims), new Uint8Array(4))).toThrow(ApiError);
    },
  );
});

describe('a message about a field of the body', () => {
  it.each([
    ['body/pin: 4 to 12 digits are expected', 'PIN: 4 to 12 digits are expected'],
    ['body: /name: there is no account with this name', 'Name: there is no account with this name'],
    [
      '/cases/0/case: either the id of a case or a scenario is expected',
      'Cases 1 case: either the id of a case or a scenario is expected',
    ],
    ['body: /due_utc_us: a whole number is expected', 'Due: a whole number is expected'],
    ['body: is no JSON', 'is no JSON'],
    ['trials/a.csv:12: column 3 is no number', 'trials/a.csv:12: column 3 is no number'],
    ['the name is taken', 'the name is taken'],
  ])('"%s" names the field as a person does', (message, shown) => {
    expect(withoutPointer(message)).toBe(shown);
  });
});
