/** The answer: touch the wall on the unrolled tract, then say how sure you are. */
import { useState, type MouseEvent } from 'react';
import { marked, say } from '@/language';
import { Button, wallName } from '@/ui';
import { formatLength, formatShare, metre, share } from '@/units';
import type { Answer, Send, Wall } from './station';
import styles from './kiosk.module.css';

interface Props {
  readonly rig: 'palpation' | 'probing';
  readonly length_m: number;
  readonly send: Send;
}

const kSides = ['medial', 'superior', 'lateral', 'inferior'] as const;
const kSure = [0, 0.25, 0.5, 0.75, 1] as const;
const kSureWords: Record<(typeof kSure)[number], string> = {
  0: marked('a guess'),
  0.25: marked('unsure'),
  0.5: marked('half sure'),
  0.75: marked('quite sure'),
  1: marked('certain'),
};

/** Nothing is chosen yet; no wall is broken; or this wall, and how deep. */
type Choice = { readonly wall: Wall | null; readonly share: number | null } | undefined;

/** How deep the finger touched, as a share of the length; a key has no place, so the middle. */
function touchedAt(event: MouseEvent<HTMLButtonElement>): number {
  const box = event.currentTarget.getBoundingClientRect();
  if (event.detail === 0 || box.height === 0) return 0.5;
  return Math.min(Math.max((event.clientY - box.top) / box.height, 0), 1);
}

export function AnswerScreen({ rig, length_m, send }: Props) {
  const [choice, setChoice] = useState<Choice>();
  const [sure, setSure] = useState<number>();
  const deep = rig === 'probing' && choice?.share != null ? choice.share * length_m : undefined;
  const give = () => {
    if (choice === undefined || sure === undefined) return;
    const answer: Answer = {
      breach: choice.wall !== null,
      wall: choice.wall,
      confidence: sure,
      ...(deep === undefined ? {} : { depth_m: deep }),
    };
    send({ command: 'answer', answer });
  };
  return (
    <section className={styles.answer}>
      <h1>{say('Where is a breach?')}</h1>
      <p>{say('Touch the wall of the unrolled tract: the entry is at the top.')}</p>
      <div className={styles.tract}>
        <div className={styles.depths} aria-hidden="true">
          <span>0</span>
          <span>{formatLength(metre(length_m), 0)}</span>
        </div>
        {kSides.map((side) => (
          <Button
            key={side}
            className={styles.wall}
            pressed={choice?.wall === side}
            onClick={(event) => setChoice({ wall: side, share: touchedAt(event) })}
          >
            {wallName(side)}
            {choice?.wall === side && choice.share !== null && rig === 'probing' ? (
              <span className={styles.mark} style={{ top: `${String(choice.share * 100)}%` }} aria-hidden="true" />
            ) : null}
          </Button>
        ))}
        <Button
          className={styles.bottom}
          pressed={choice?.wall === 'anterior'}
          onClick={() => setChoice({ wall: 'anterior', share: 1 })}
        >
          {say('bottom (anterior)')}
        </Button>
      </div>
      <Button
        className={styles.wide}
        pressed={choice?.wall === null}
        onClick={() => setChoice({ wall: null, share: null })}
      >
        {say('No breach')}
      </Button>
      <fieldset className={styles.sure}>
        <legend>{say('How sure are you?')}</legend>
        {kSure.map((value) => (
          <Button key={value} pressed={sure === value} onClick={() => setSure(value)}>
            {formatShare(share(value))} <small>{say(kSureWords[value])}</small>
          </Button>
        ))}
      </fieldset>
      <div className={styles.give}>
        <p role="status">
          {choice === undefined ? say('Touch a wall, or “No breach”.') : chosenText(choice.wall, deep)}
          {choice !== undefined && sure === undefined ? ` ${say('Now say how sure you are.')}` : ''}
        </p>
        <Button
          look="solid"
          className={styles.main_button}
          disabled={choice === undefined || sure === undefined}
          onClick={give}
        >
          {say('Give the answer')}
        </Button>
      </div>
    </section>
  );
}

function chosenText(wall: Wall | null, depth_m: number | undefined): string {
  if (wall === null) return say('No breach.');
  return depth_m === undefined
    ? say('Breach: {wall}.', { wall: wallName(wall) })
    : say('Breach: {wall}, {depth} deep.', { wall: wallName(wall), depth: formatLength(metre(depth_m), 0) });
}
