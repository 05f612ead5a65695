// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from '@tanstack/react-query';
import { cleanup, render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { afterEach, expect, it, vi } from 'vitest';
import { useSavedViews } from './view-queries';

afterEach(cleanup);

const answer = (views: readonly unknown[]) => new Response(JSON.stringify({ views }), { status: 200 });
const saved = { id: 'v1', page: 'trials', name: 'Failures', search: 'answer=incorrect', made_utc_us: 1 };

function Views() {
  const { views, save } = useSavedViews('trials');
  return (
    <>
      <button onClick={() => void save(saved.name, saved.search)}>Save</button>
      <p>{views.map(({ name }) => name).join() || 'none'}</p>
    </>
  );
}

it('a list of views that was asked for before one was saved does not replace the newer list', async () => {
  let answerList: (list: Response) => void = () => undefined;
  vi.spyOn(globalThis, 'fetch').mockImplementation((_, init) =>
    init?.method === 'POST'
      ? Promise.resolve(answer([saved]))
      : new Promise((resolve) => {
          answerList = resolve;
        }),
  );
  render(
    <QueryClientProvider client={new QueryClient({ defaultOptions: { queries: { retry: false } } })}>
      <Views />
    </QueryClientProvider>,
  );
  await userEvent.click(screen.getByRole('button', { name: 'Save' }));
  await screen.findByText('Failures');
  answerList(answer([]));
  await new Promise((resolve) => setTimeout(resolve, 50));
  expect(screen.getByText('Failures')).toBeTruthy();
});
