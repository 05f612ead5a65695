// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from '@tanstack/react-query';
import { cleanup, render, screen, waitFor } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { useState } from 'react';
import * as v from 'valibot';
import { afterEach, describe, expect, it, vi } from 'vitest';
import { endSession, onSessionEnd } from '@/api';
import { requestJson } from '@/api/client';
import { noteSignOut } from './ended';
import { SessionGate } from './session-gate';

afterEach(() => {
  cleanup();
  noteSignOut();
});

const json = (body: unknown, status: number) => Promise.resolve(new Response(JSON.stringify(body), { status }));

/** GET /session answers that nobody is there; POST as given. */
function open(post: () => Promise<Response>) {
  vi.spyOn(globalThis, 'fetch').mockImplementation((_, init) =>
    init?.method === 'POST' ? post() : json({ error: 'nobody', code: 'unauthorised' }, 401),
  );
  render(
    <QueryClientProvider client={new QueryClient({ defaultOptions: { queries: { retry: false } } })}>
      <SessionGate waiting="waiting">the page</SessionGate>
    </QueryClientProvider>,
  );
}

async function attempt(name = 'faculty', password = 'secret') {
  const nameField = await screen.findByLabelText('Name');
  await userEvent.type(nameField, name);
  await userEvent.type(screen.getByLabelText('Password'), `${password}{Enter}`);
}

describe('signing in', () => {
  it('puts the cursor into the name, shows the page after the right password, by keyboard alone', async () => {
    open(() => json({ name: 'faculty', role: 'admin' }, 200));
    await waitFor(() => expect(document.activeElement).toBe(screen.getByLabelText('Name')));
    await attempt();
    expect(await screen.findByText('the page')).toBeTruthy();
  });

  it.each([
    [401, 'Name or password is wrong.'],
    [429, 'Too many failed attempts. Try again in a few minutes.'],
    [503, 'the database is away'],
  ])('says after status %d: %s', async (status, sentence) => {
    open(() => json({ error: 'the database is away', code: 'x' }, status));
    await attempt();
    await waitFor(() => expect(screen.getByRole('alert').textContent).toBe(sentence));
    expect((screen.getByLabelText('Password') as HTMLInputElement).value, 'the wrong password is gone').toBe('');
    expect(document.activeElement).toBe(screen.getByLabelText('Password'));
  });

  it('says in how many seconds the server takes another attempt', async () => {
    open(() =>
      Promise.resolve(
        new Response(JSON.stringify({ error: 'x', code: 'too_many' }), {
          status: 429,
          headers: { 'Retry-After': '90' },
        }),
      ),
    );
    await attempt();
    await waitFor(() =>
      expect(screen.getByRole('alert').textContent).toBe('Too many failed attempts. Try again in 90 s.'),
    );
  });

  it('offers the provider of identities that the server has, and says how its answer went', async () => {
    window.history.replaceState(null, '', '/?sign_in=unknown');
    vi.spyOn(globalThis, 'fetch').mockImplementation((input) =>
      String(input).endsWith('/session/oidc')
        ? json({ offered: true, label: 'Sign in with the hospital' }, 200)
        : json({ error: 'nobody', code: 'unauthorised' }, 401),
    );
    render(
      <QueryClientProvider client={new QueryClient({ defaultOptions: { queries: { retry: false } } })}>
        <SessionGate waiting="waiting">the page</SessionGate>
      </QueryClientProvider>,
    );
    const link = await screen.findByRole('link', { name: 'Sign in with the hospital' });
    expect(link.getAttribute('href')).toBe('/api/v1/session/oidc/start');
    expect(screen.getByRole('alert').textContent).toContain('no account on this server is linked');
    window.history.replaceState(null, '', '/');
  });

  it('offers none where there is none', async () => {
    open(() => json({}, 200));
    await screen.findByLabelText('Name');
    expect(screen.queryByRole('link')).toBeNull();
  });

  it('says that the server is away when it is', async () => {
    open(() => Promise.reject(new TypeError('Failed to fetch')));
    await attempt();
    await waitFor(() => expect(screen.getByRole('alert').textContent).toContain('does not answer'));
  });

  it('asks nothing of the server while a field is empty', async () => {
    const post = vi.fn(() => json({}, 200));
    open(post);
    await screen.findByLabelText('Name');
    await userEvent.click(screen.getByRole('button', { name: 'Sign in' }));
    expect(post).not.toHaveBeenCalled();
  });
});

describe('a session that ends by itself', () => {
  /** The session of the person `who`, as the server has it: null for nobody. */
  function page(who: { name: string | null }) {
    vi.spyOn(globalThis, 'fetch').mockImplementation((input, init) => {
      const path = new URL(String(input), 'http://x').pathname;
      if (path === '/api/v1/session' && init?.method === 'POST') {
        const { name } = JSON.parse(String(init.body)) as { name: string };
        who.name = name;
      }
      if (path === '/api/v1/session/oidc') return json({ offered: false, label: null }, 200);
      if (who.name === null) return json({ error: 'nobody', code: 'unauthorised' }, 401);
      return path === '/api/v1/session'
        ? json({ id: who.name, name: who.name, role: 'admin' }, 200)
        : json({ saved: who.name }, 200);
    });
    const client = new QueryClient({ defaultOptions: { queries: { retry: false } } });
    onSessionEnd(() => endSession(client));
    function Form() {
      const [saved, setSaved] = useState('');
      return (
        <>
          <input aria-label="Title" />
          <button
            onClick={() =>
              void requestJson('/things', v.object({ saved: v.string() })).then(
                (answer) => setSaved(`saved by ${answer.saved}`),
                (reason: Error) => setSaved(reason.message),
              )
            }
          >
            Save
          </button>
          <p>{saved}</p>
        </>
      );
    }
    render(
      <QueryClientProvider client={client}>
        <SessionGate waiting="waiting">
          <Form />
        </SessionGate>
      </QueryClientProvider>,
    );
  }

  it('keeps what was typed, and what was sent goes through after the sign-in', async () => {
    const who: { name: string | null } = { name: 'faculty' };
    page(who);
    await userEvent.type(await screen.findByLabelText('Title'), 'Week 3');
    who.name = null;
    await userEvent.click(screen.getByRole('button', { name: 'Save' }));
    await screen.findByText(/Your session has ended/);
    expect(screen.queryByRole('textbox', { name: 'Title' }), 'hidden while nobody is signed in').toBeNull();
    await attempt();
    expect(await screen.findByText('saved by faculty')).toBeTruthy();
    expect((screen.getByRole('textbox', { name: 'Title' }) as HTMLInputElement).value).toBe('Week 3');
  });

  it('shows and sends nothing of it to another person', async () => {
    const who: { name: string | null } = { name: 'faculty' };
    page(who);
    await userEvent.type(await screen.findByLabelText('Title'), 'Week 3');
    who.name = null;
    await userEvent.click(screen.getByRole('button', { name: 'Save' }));
    await screen.findByText(/Your session has ended/);
    await attempt('director');
    await waitFor(() => expect((screen.getByRole('textbox', { name: 'Title' }) as HTMLInputElement).value).toBe(''));
    expect(screen.queryByText(/saved by/)).toBeNull();
  });
});
