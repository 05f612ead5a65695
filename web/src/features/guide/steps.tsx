import { Link } from 'wouter';
import { language, say } from '@/language';
import styles from './guide.module.css';
import type { Step } from './pages';

/** Address of each picture that the tests have made, by its name: in the language that is spoken, or else in English. A step without one stands alone. */
const kMade = import.meta.glob<string>('./pictures/**/*.jpg', { eager: true, query: '?url', import: 'default' });
const addressOf = (name: string | undefined) =>
  name === undefined ? undefined : (kMade[`./pictures/${language()}/${name}.jpg`] ?? kMade[`./pictures/${name}.jpg`]);

export const isMade = (name: string) => addressOf(name) !== undefined;

/** Steps in order, each with its picture. */
export function Steps({ of }: { readonly of: readonly Step[] }) {
  return (
    <ol className={styles.steps}>
      {of.map(({ title, text, to, picture }) => (
        <li key={title}>
          <strong>{say(title)}</strong>
          <p>
            {say(text)} {to ? <Link href={to.href}>{say(to.name)}</Link> : null}
          </p>
          {picture && addressOf(picture.name) ? (
            <img
              className={styles.picture}
              src={addressOf(picture.name)}
              alt={say(picture.shows)}
              width={1200}
              height={750}
              loading="lazy"
            />
          ) : null}
        </li>
      ))}
    </ol>
  );
}
