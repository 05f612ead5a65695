import { expect, it } from 'vitest';
import { cardAddress, readCard } from './sign-in-card';

it('reads from a card what was written on it', () => {
  for (const name of ['Berg, Ida', 'a:b', 'ö/ü #1 %'])
    expect(readCard(new URL(cardAddress('https://lab.example:8443', name, 'k7qf2mxd')).hash)).toEqual({
      name,
      password: 'k7qf2mxd',
    });
});

it('takes nothing else for a card', () => {
  for (const hash of ['', '#results', '#card=', '#card=ida', '#card=:x', '#card=a:b:c', '#card=%E0%A4%A:x'])
    expect(readCard(hash), hash).toBeNull();
});
