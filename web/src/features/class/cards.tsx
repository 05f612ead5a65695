import { encode } from 'uqr';
import { cardAddress } from '@/api';
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
      aria-label={`Code that opens the sign-in of ${name}`}
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
      title={`${cards.length} sign-in ${cards.length === 1 ? 'card' : 'cards'}`}
      aside={
        <span className={styles.screen}>
          <Button look="solid" onClick={() => window.print()}>
            Print cards
          </Button>
        </span>
      }
    >
      <div className={styles.screen}>
        <Notice tone="warn" title="Print the cards now: the passwords are shown only here.">
          A card works once: its password must be changed at the first sign-in. If a card is lost, make a new one under
          “Change accounts”.
        </Notice>
      </div>
      <ul className={styles.cards} data-part="cards">
        {cards.map(({ name, password, badge }) => (
          <li key={name} className={styles.signIn}>
            <Code text={cardAddress(origin, name, password)} name={name} />
            <div>
              <p className={styles.person}>{name}</p>
              <dl className={styles.facts}>
                <dt>Address</dt>
                <dd>{host}</dd>
                <dt>First password</dt>
                <dd className={styles.password}>{password}</dd>
                <dt>Badge</dt>
                <dd>{badge ?? 'none yet'}</dd>
              </dl>
              <p className={styles.small}>Scan the code, or type name and password. Then choose your own password.</p>
            </div>
          </li>
        ))}
      </ul>
    </Card>
  );
}
