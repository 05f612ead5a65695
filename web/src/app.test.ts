// @vitest-environment jsdom
import { onlineManager } from '@tanstack/react-query';
import { afterEach, expect, it } from 'vitest';
import { makeClient } from './app';

afterEach(() => onlineManager.setOnline(true));

it('asks the server even when the browser thinks that there is no network', async () => {
  onlineManager.setOnline(false);
  await expect(
    makeClient().fetchQuery({ queryKey: ['a server in the house'], queryFn: () => Promise.resolve(7) }),
  ).resolves.toBe(7);
});
