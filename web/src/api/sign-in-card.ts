/** What the code on a sign-in card holds: name and first password behind the address's #, which a browser sends to nobody. */
const kBegin = '#card=';

export const cardAddress = (origin: string, name: string, password: string) =>
  `${origin}/${kBegin}${encodeURIComponent(name)}:${encodeURIComponent(password)}`;

/** Name and password of a card's address, from its part behind and with the #; null: it is none. */
export function readCard(hash: string): { readonly name: string; readonly password: string } | null {
  if (!hash.startsWith(kBegin)) return null;
  const [name = '', password = '', ...more] = hash.slice(kBegin.length).split(':');
  if (name === '' || password === '' || more.length > 0) return null;
  try {
    return { name: decodeURIComponent(name), password: decodeURIComponent(password) };
  } catch {
    return null;
  }
}
