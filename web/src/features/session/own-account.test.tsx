// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from '@tanstack/react-query';
import { cleanup, render, screen, waitFor } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { afterEach, describe, expect, it, vi } from 'vitest';
import { chooseLanguage } from '@/language';
import { OwnAccountPage } from './own-account-page';

afterEach(cleanup);

const json = (body: unknown, status: number) => Promise.resolve(new Response(JSON.stringify(body), { status }));

/** Shows the page; what is sent is answered by `post`. */
function open(post: (path: string, body: Record<string, unknown>) => Promise<Response>) {
  vi.spyOn(globalThis, 'fetch').mockImplementation((input, init) =>
    init?.method === 'POST'
      ? post(String(input), JSON.parse(String(init.body ?? '{}')) as Record<string, unknown>)
      : json({ error: 'nobody', code: 'unauthorised' }, 401),
  );
  render(
    <QueryClientProvider client={new QueryClient({ defaultOptions: { queries: { retry: false } } })}>
      <OwnAccountPage />
    </QueryClientProvider>,
  );
}

describe('the own account', () => {
  it('asks for a one-time code once the server does, and sends it with the passwords', async () => {
    const sent: Record<string, unknown>[] = [];
    open((_, body) => {
      sent.push(body);
      return 'code' in body
        ? Promise.resolve(new Response(null, { status: 204 }))
        : json({ error: 'body: /code: a one-time code is asked for', code: 'code_needed' }, 403);
    });
    await userEvent.type(screen.getByLabelText('Current password'), 'the old password');
    await userEvent.type(screen.getByLabelText('New password'), 'a longer password');
    await userEvent.type(screen.getByLabelText('Repeat new password'), 'a longer password{Enter}');
    await userEvent.type(await screen.findByLabelText('One-time code'), '123456{Enter}');
    await waitFor(() => expect(screen.getByText('The password was changed.')).toBeTruthy());
    expect(sent).toEqual([
      { old: 'the old password', new: 'a longer password' },
      { old: 'the old password', new: 'a longer password', code: '123456' },
    ]);
  });

  it('stores the language on the account before the pages speak it', async () => {
    const sent: [string, Record<string, unknown>][] = [];
    let refuses = true;
    open((path, body) => {
      sent.push([path, body]);
      return refuses
        ? json({ error: 'the database does not answer', code: 'unavailable' }, 503)
        : Promise.resolve(new Response(null, { status: 204 }));
    });
    const choice = screen.getByRole('combobox', { name: 'Language' });
    await userEvent.selectOptions(choice, 'Deutsch');
    expect(await screen.findByText('the database does not answer')).toBeTruthy();
    expect(document.documentElement.lang).not.toBe('de');
    refuses = false;
    await userEvent.selectOptions(choice, 'Deutsch');
    // The catalogue is read and compiled meanwhile.
    await waitFor(() => expect(document.documentElement.lang).toBe('de'), { timeout: 20_000 });
    expect(sent).toEqual(Array(2).fill(['/api/v1/session/language', { language: 'de' }]));
    await chooseLanguage('en');
  }, 30_000);

  it('sets up one-time codes by the password alone', async () => {
    const sent: [string, Record<string, unknown>][] = [];
    open((path, body) => {
      sent.push([path, body]);
      return json({ secret: 'ABCD', uri: 'otpauth://totp/x' }, 200);
    });
    const begin = screen.getByRole('button', { name: 'Set up one-time codes' });
    expect((begin as HTMLButtonElement).disabled).toBe(true);
    await userEvent.type(screen.getByLabelText('Your password'), 'the old password');
    await userEvent.click(begin);
    expect(await screen.findByText('ABCD')).toBeTruthy();
    expect(sent).toEqual([['/api/v1/session/codes', { password: 'the old password' }]]);
  });
});
