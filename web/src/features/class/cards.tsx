import { encode } from 'uqr';
import { cardAddress } from '@/api';
import { say } from '@/language';
import { Button, Card, Notice } from '@/ui';
import styles from './class.module.css';

export interface SignInCard {
  readonly name: string;
  readonly password: string;
  readonly badge: string | null;
}

/** A QR code as one path: a module is a square of the picture's unit. */
function Code({ text, name }: { readonly text: string; readonly name: string }) {
  const { data, size } = encode(text, { ecc: 'M', border: 2 });
  const path = data.flatMap((row, y) => row.flatMap((dark, x) => (dark ? [`M${x} ${y}h1v1h-1z`] : []))).join('');
  return (
    <svg
      className={styles.code}
      viewBox={`0 0 ${size} ${size}`}
      role="img"
      aria-label={say('Code that opens the sign-in of {name}', { name })}
      shapeRendering="crispEdges"
    >
      <rect width={size} height={size} fill="#fff" />
      <path d={path} fill="#000" />
    </svg>
  );
}

/** One-time sign-in cards, ten on a sheet. The passwords are on no other page and are not stored. */
export function Cards({ cards }: { readonly cards: readonly SignInCard[] }) {
  const { origin, host } = window.location;
  return (
    <Card
      title={say('{count, plural, one {# sign-in card} other {# sign-in cards}}', { count: cards.length })}
      aside={
        <span className={styles.screen}>
          <Button look="solid" onClick={() => window.print()}>
            {say('Print cards')}
          </Button>
        </span>
      }
    >
      <div className={styles.screen}>
        <Notice tone="warn" title={say('Print the cards now: the passwords are shown only here.')}>
          {say(
            'A card works once: its password must be changed at the first sign-in. If a card is lost, make a new one under “Change accounts”.',
          )}
        </Notice>
      </div>
      <ul className={styles.cards} data-part="cards">
        {cards.map(({ name, password, badge }) => (
          <li key={name} className={styles.signIn}>
            <Code text={cardAddress(origin, name, password)} name={name} />
            <div>
              <p className={styles.person}>{name}</p>
              <dl className={styles.facts}>
                <dt>{say('Address')}</dt>
                <dd>{host}</dd>
                <dt>{say('First password')}</dt>
                <dd className={styles.password}>{password}</dd>
                <dt>{say('Badge')}</dt>
                <dd>{badge ?? say('none yet')}</dd>
              </dl>
              <p className={styles.small}>
                {say('Scan the code, or type name and password. Then choose your own password.')}
              </p>
            </div>
          </li>
        ))}
      </ul>
    </Card>
  );
}
