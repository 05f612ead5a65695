import { createElement, Fragment, type ReactNode } from 'react';
import { filled } from './language';

interface Props {
  /** English, with <name>…</name> where a part is more than text. */
  readonly text: string;
  readonly values?: Readonly<Record<string, string | number>>;
  /** What each name makes of the words between its tags. */
  readonly parts: Readonly<Record<string, (words: ReactNode) => ReactNode>>;
}

/** A sentence of which parts are links, code or stressed; a translation puts them where its grammar wants them. */
export function Sentence({ text, values = {}, parts }: Props) {
  const tags = Object.fromEntries(
    Object.entries(parts).map(([name, part]) => [
      name,
      (words: readonly ReactNode[]) => part(createElement(Fragment, {}, ...words)),
    ]),
  );
  const shown = filled(text, (format) => format.format<ReactNode>({ ...values, ...tags }), false);
  return createElement(Fragment, {}, ...(Array.isArray(shown) ? (shown as ReactNode[]) : [shown as ReactNode]));
}
