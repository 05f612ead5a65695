import { useEffect, useRef, useSyncExternalStore, type KeyboardEvent } from 'react';
import type { Cursor } from '@/charts';
import { say } from '@/language';
import { Button, Select } from '@/ui';
import { formatForce, formatLength, formatTime, metre, newton, second } from '@/units';
import { rowAt, type Way } from './align';
import styles from './debrief.module.css';
import { neighbour, type Moment } from './marks';
import { kSpeeds, type Player } from './use-player';

/** What keys do where nothing else takes them: as in any player. */
export function onPlayerKey(
  event: KeyboardEvent,
  player: Player,
  now: number,
  duration_s: number,
  moments: readonly Moment[],
): void {
  const target = event.target as HTMLElement;
  if (
    event.ctrlKey ||
    event.metaKey ||
    event.altKey ||
    /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName) ||
    target.getAttribute('role') === 'application'
  )
    return;
  if (event.key === ' ' && target.tagName === 'BUTTON') return;
  const step = event.shiftKey ? 0.1 : 1;
  const jump = (direction: 1 | -1) => {
    const to = neighbour(moments, now, direction);
    if (to) player.seek(to.t_s);
  };
  const act: Record<string, (() => void) | undefined> = {
    ' ': player.toggle,
    k: player.toggle,
    ArrowLeft: () => player.seek(now - step),
    ArrowRight: () => player.seek(now + step),
    Home: () => player.seek(0),
    End: () => player.seek(duration_s),
    n: () => jump(1),
    p: () => jump(-1),
  };
  const done = act[event.key];
  if (!done) return;
  event.preventDefault();
  done();
}

/** Moves with the cursor without drawing the page anew. */
function Scrubber({
  duration_s,
  cursor,
  player,
}: {
  readonly duration_s: number;
  readonly cursor: Cursor;
  readonly player: Player;
}) {
  const input = useRef<HTMLInputElement>(null);
  useEffect(() => {
    const follow = () => {
      const now = cursor.now() ?? 0;
      if (input.current) {
        input.current.value = String(now);
        input.current.setAttribute('aria-valuetext', formatTime(second(now), 1));
      }
    };
    follow();
    return cursor.subscribe(follow);
  }, [cursor]);
  return (
    <input
      ref={input}
      type="range"
      className={styles.scrub}
      aria-label={say('Time in the trial')}
      min={0}
      max={duration_s}
      step={0.01}
      defaultValue={0}
      onChange={(event) => player.seek(Number(event.target.value))}
    />
  );
}

/** The numbers of the moment. */
export function Now({
  cursor,
  way,
  ghost,
}: {
  readonly cursor: Cursor;
  readonly way: Way;
  readonly ghost: { way: Way; at: (t: number) => number } | null;
}) {
  const now = useSyncExternalStore(cursor.subscribe, cursor.now) ?? 0;
  const row = rowAt(way.t_s, now);
  const other = ghost ? rowAt(ghost.way.t_s, ghost.at(now)) : 0;
  const describe = (one: Way, at: number) =>
    say('{force}, {depth} deep', {
      force: formatForce(newton(one.force_N[at] ?? 0)),
      depth: formatLength(metre(one.depth_m[at] ?? 0)),
    });
  return (
    <p className={styles.now} data-part="now">
      <strong>{formatTime(second(now), 1)}</strong> <span>{describe(way, row)}</span>
      {ghost ? (
        <span className={styles.ghostText}>{say('example: {reading}', { reading: describe(ghost.way, other) })}</span>
      ) : null}
    </p>
  );
}

interface Props {
  readonly duration_s: number;
  readonly cursor: Cursor;
  readonly player: Player;
  readonly moments: readonly Moment[];
}

/** Play, speed, scrub, jump. */
export function Transport({ duration_s, cursor, player, moments }: Props) {
  const jump = (direction: 1 | -1) => {
    const to = neighbour(moments, cursor.now() ?? 0, direction);
    if (to) player.seek(to.t_s);
  };
  return (
    <div className={styles.transport} role="group" aria-label={say('Replay')}>
      <Button
        look="solid"
        label={player.playing ? say('Pause') : say('Play')}
        className={styles.play}
        onClick={player.toggle}
      >
        {player.playing ? '❚❚' : '▶'}
      </Button>
      <Button label={say('Previous event')} onClick={() => jump(-1)}>
        |◀
      </Button>
      <Button label={say('Next event')} onClick={() => jump(1)}>
        ▶|
      </Button>
      <Scrubber duration_s={duration_s} cursor={cursor} player={player} />
      <Select
        label={<span className="hidden-visually">{say('Speed')}</span>}
        value={String(player.speed)}
        options={kSpeeds.map((speed) => ({ value: String(speed), text: `${speed} ×` }))}
        onChange={(event) => player.setSpeed(Number(event.target.value))}
      />
    </div>
  );
}
