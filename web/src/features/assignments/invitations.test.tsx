// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from '@tanstack/react-query';
import { cleanup, render, screen, waitFor } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { afterEach, describe, expect, it, vi } from 'vitest';
import { Invitations } from './invitations';

afterEach(cleanup);

const kInvitation = { cohort_id: 'c1', cohort_name: 'Residents 2027', made_utc_us: 1, made_by: 'F. Senior' };

/** A server with these invitations; after an answer none are left. Returns what was posted. */
function open(invitations: readonly (typeof kInvitation)[]) {
  const posted: string[] = [];
  vi.spyOn(globalThis, 'fetch').mockImplementation((address, init) => {
    if (init?.method === 'POST') posted.push(String(address));
    return Promise.resolve(
      new Response(JSON.stringify({ invitations: init?.method === 'POST' ? [] : invitations }), { status: 200 }),
    );
  });
  render(
    <QueryClientProvider client={new QueryClient({ defaultOptions: { queries: { retry: false } } })}>
      <Invitations />
    </QueryClientProvider>,
  );
  return posted;
}

describe('invitations into cohorts', () => {
  it('say who invites, and what joining opens', async () => {
    open([kInvitation]);
    expect(await screen.findByText('Residents 2027')).toBeTruthy();
    expect(screen.getByText('F. Senior')).toBeTruthy();
    expect(screen.getByText(/see the trials of all its members/)).toBeTruthy();
  });

  it.each([
    ['Accept', 'accept'],
    ['Decline', 'decline'],
  ])('%s is sent, and the invitation is gone', async (label, deed) => {
    const posted = open([kInvitation]);
    await userEvent.click(await screen.findByRole('button', { name: `${label}: Residents 2027` }));
    await waitFor(() => expect(screen.queryByText('Residents 2027')).toBeNull());
    expect(posted).toEqual([`/api/v1/session/invitations/c1/${deed}`]);
  });
});
