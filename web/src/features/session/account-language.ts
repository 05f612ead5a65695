/** The language of an account: it follows the person to any browser, to the kiosk and into e-mails. */
import { useQuery, useQueryClient, type QueryClient } from '@tanstack/react-query';
import { useEffect } from 'react';
import { sessionQuery, setLanguage } from '@/api';
import { chooseLanguage, preferredLanguage, readLanguage, speak, type Language } from '@/language';

/** The language of who is signed in, or else the browser's. */
export const sessionLanguage = (client: QueryClient): Language =>
  readLanguage(client.getQueryData(sessionQuery.queryKey)?.language) ?? preferredLanguage();

/** Speaks the language of whoever signs in. A session that ends by itself changes nothing: the page stays as it was. */
export function useAccountLanguage(): void {
  const client = useQueryClient();
  const session = useQuery({ ...sessionQuery, enabled: false }).data;
  const name = session?.name,
    chosen = session?.language;
  useEffect(() => {
    if (name !== undefined) speak(sessionLanguage(client)).catch(() => undefined);
  }, [client, name, chosen]);
}

/** Stores the choice on the account, then changes the pages. */
export async function chooseOwnLanguage(client: QueryClient, chosen: Language): Promise<void> {
  await setLanguage(chosen);
  client.setQueryData(sessionQuery.queryKey, (now) => (now ? { ...now, language: chosen } : now));
  await chooseLanguage(chosen);
}

/** The choice at the foot of each page: of the account of whoever is signed in, or else of the browser. */
export function useChooseLanguage(): (chosen: Language) => void {
  const client = useQueryClient();
  return (chosen) => {
    const signedIn = client.getQueryData(sessionQuery.queryKey);
    // What the account cannot store holds in this browser.
    void (signedIn ? chooseOwnLanguage(client, chosen).catch(() => chooseLanguage(chosen)) : chooseLanguage(chosen));
  };
}
