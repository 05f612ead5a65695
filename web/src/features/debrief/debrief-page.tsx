import { useQuery } from '@tanstack/react-query';
import { useMemo, useState } from 'react';
import { Link } from 'wouter';
import {
  ApiError,
  commentsQuery,
  forceDepthQuery,
  pathQuery,
  previewQuery,
  referenceWayQuery,
  sessionQuery,
  trialQuery,
  type ReferenceWay,
  type Trial,
  personOf,
} from '@/api';
import { makeCursor, TractView, type Cursor } from '@/charts';
import { say, Sentence } from '@/language';
import { Badge, Button, Card, Notice, Skeleton, usePalette, useTitle, wallName } from '@/ui';
import { formatDateTime, formatDuration } from '@/units';
import { byProgress, byTime, type Moments, type Way } from './align';
import { Comments } from './comments';
import { BreachCard } from './cross-section';
import styles from './debrief.module.css';
import { ExampleField, ReleaseField, type Choice } from './example';
import { breaches, momentsOf } from './marks';
import { Ratings } from './ratings';
import { Timeline } from './timeline';
import { Now, onPlayerKey, Transport } from './transport';
import { usePlayer } from './use-player';

type Tips = readonly (readonly [number, number, number])[];

/** Path of the tip of either rig, once it is loaded. */
function useWay(trial: Trial): {
  way: Way | undefined;
  tips: Tips | null;
  failed: Error | null;
  retry: () => void;
  curve: ReturnType<typeof breaches>;
} {
  const palpation = trial.rig === 'palpation';
  const path = useQuery({ ...pathQuery(trial.id), enabled: palpation });
  const depth = useQuery({ ...forceDepthQuery(trial.id), enabled: !palpation });
  const { tract } = trial;
  const way = useMemo<Way | undefined>(() => {
    if (!palpation) return depth.data;
    if (!path.data) return undefined;
    const depth_m = path.data.tip_m.map((tip) =>
      tract
        ? [0, 1, 2].reduce((sum, i) => sum + ((tip[i] ?? 0) - (tract.entry_m[i] ?? 0)) * (tract.axis[i] ?? 0), 0)
        : 0,
    );
    return { t_s: path.data.t_s, force_N: path.data.force_N, depth_m };
  }, [palpation, path.data, depth.data, tract]);
  const curve = useMemo(() => breaches(depth.data), [depth.data]);
  return {
    way,
    tips: path.data?.tip_m ?? null,
    failed: path.error ?? depth.error,
    retry: () => {
      void (palpation ? path : depth).refetch();
    },
    curve,
  };
}

interface Ghost {
  readonly way: ReferenceWay;
  readonly at: Moments;
}

function Picture({
  trial,
  way,
  tips,
  ghost,
  cursor,
}: {
  readonly trial: Trial;
  readonly way: Way;
  readonly tips: Tips;
  readonly ghost: Ghost | null;
  readonly cursor: Cursor;
}) {
  const preview = useQuery(previewQuery(trial.case_id));
  const palette = usePalette();
  const path = useMemo(() => ({ t_s: way.t_s, tip_m: tips, force_N: way.force_N }), [way, tips]);
  const other = useMemo(
    () =>
      ghost?.way.tip_m
        ? { path: { t_s: ghost.way.t_s, tip_m: ghost.way.tip_m, force_N: ghost.way.force_N }, at: ghost.at }
        : null,
    [ghost],
  );
  if (!trial.tract) return <p>{say('The case of this trial is not on this server.')}</p>;
  if (preview.isPending) return <Skeleton height="444px" />;
  return (
    <>
      {preview.isError ? (
        <Notice tone="warn" title={say('The bone could not be loaded. The view shows the tract without it.')}>
          {preview.error.message}
        </Notice>
      ) : null}
      <TractView
        tract={trial.tract}
        path={path}
        bone={preview.data ?? null}
        cursor={cursor}
        ghost={other}
        palette={palette}
        summary={say(
          'The tract with the surrounding bone and the path of the tip, coloured by force. A ball marks the current position; a second ball marks that of the example.',
        )}
        button={(label, text, press, pressed) => (
          <Button label={label} onClick={press} {...(pressed === undefined ? {} : { pressed })}>
            {text}
          </Button>
        )}
      />
    </>
  );
}

const sides = (found: string | null, none: string) =>
  found === null ? none : say('{wall} breach', { wall: wallName(found) });

function Verdict({ trial }: { readonly trial: Trial }) {
  const { answer, truth, scenario } = trial;
  const given = answer
    ? answer.breach
      ? answer.wall
        ? sides(answer.wall, '')
        : say('a breach')
      : say('no breach')
    : say('no answer');
  const was =
    trial.rig === 'probing'
      ? scenario
        ? scenario.walls.length > 0
          ? say('a breach')
          : say('no breach')
        : null
      : truth
        ? sides(truth.breached ?? null, say('no breach'))
        : null;
  const right = trial.metrics.find((metric) => metric.shown_as === 'correct_or_incorrect')?.value ?? null;
  return (
    <p className={styles.verdict}>
      <span>
        <Sentence
          text="Answer: <strong>{given}</strong>."
          values={{ given }}
          parts={{ strong: (words) => <strong>{words}</strong> }}
        />
      </span>{' '}
      {was === null ? null : (
        <span>
          <Sentence
            text="Truth: <strong>{was}</strong>."
            values={{ was }}
            parts={{ strong: (words) => <strong>{words}</strong> }}
          />
        </span>
      )}
      {right === null ? null : right > 0.5 ? (
        <Badge tone="good">{say('correct')}</Badge>
      ) : (
        <Badge tone="bad">{say('incorrect')}</Badge>
      )}
    </p>
  );
}

function Replay({ trial, may }: { readonly trial: Trial; readonly may: boolean }) {
  const [cursor] = useState(makeCursor);
  const [choice, setChoice] = useState<Choice>({ id: '', by: 'progress' });
  const player = usePlayer(trial.duration_s, cursor);
  const { way, tips, failed, retry, curve } = useWay(trial);
  const comments = useQuery(commentsQuery(trial.id));
  const other = useQuery({ ...referenceWayQuery(trial.id, choice.id), enabled: choice.id !== '' });
  const theirs = choice.id === '' ? undefined : other.data;
  const ghost = useMemo(
    () =>
      theirs && way ? { way: theirs, at: choice.by === 'progress' ? byProgress(way, theirs) : byTime(theirs) } : null,
    [theirs, way, choice.by],
  );
  const moments = useMemo(() => momentsOf(trial, comments.data?.comments ?? [], curve), [trial, comments.data, curve]);
  return (
    // eslint-disable-next-line jsx-a11y/no-static-element-interactions -- keys of the player work wherever one is in it
    <div
      className={styles.page}
      onKeyDown={(event) => onPlayerKey(event, player, cursor.now() ?? 0, trial.duration_s, moments)}
    >
      {failed ? (
        <Notice tone="bad" title={say('The recording could not be loaded.')} onRetry={retry}>
          {failed.message}
        </Notice>
      ) : null}
      {other.isError ? (
        <Notice tone="bad" title={say('The example could not be loaded.')}>
          {other.error.message}
        </Notice>
      ) : null}
      <div className={styles.two}>
        <Card title={say('Replay')}>
          <div className={styles.stack}>
            {way && trial.rig === 'palpation' && tips ? (
              <Picture trial={trial} way={way} tips={tips} ghost={ghost} cursor={cursor} />
            ) : null}
            {way ? null : failed ? null : <Skeleton height="640px" />}
            {way ? (
              <>
                <Transport duration_s={trial.duration_s} cursor={cursor} player={player} moments={moments} />
                <Now cursor={cursor} way={way} ghost={ghost} />
                <Timeline
                  way={way}
                  ghost={ghost}
                  duration_s={trial.duration_s}
                  cursor={cursor}
                  player={player}
                  moments={moments}
                  scenario={trial.scenario}
                />
                <p className={styles.muted}>
                  {say(
                    'Space: play or pause. Arrow keys: move by 1 s (with Shift by 0.1 s). N and P: next and previous event. Click or drag in the charts to move in time.',
                  )}
                </p>
              </>
            ) : null}
            <ExampleField trial={trial.id} choice={choice} may={may} onChoice={setChoice} />
          </div>
        </Card>
        <Card title={say('Comments')}>
          <Comments trial={trial.id} cursor={cursor} player={player} may={may} />
        </Card>
      </div>
    </div>
  );
}

/** Debriefing of a trial: replay beside an example, comments, release of results. */
export function DebriefPage({ id }: { readonly id: string }) {
  const query = useQuery(trialQuery(id));
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const may = role === 'admin' || role === 'faculty';
  const mayRate = may || role === 'director';
  const trial = query.data;
  useTitle(trial ? say('Debrief: {trial}', { trial: personOf(trial) }) : say('Debrief'));
  const missing = query.error instanceof ApiError && query.error.code === 'not_found';
  return (
    <div className={styles.page}>
      <p>
        <Link href={`/trials/${id}`}>← {say('Trial and measures')}</Link>
        {trial?.study?.id.startsWith('a-') ? (
          <>
            {' '}
            · <Link href={`/assignments/${trial.study.id}`}>{trial.study.title}</Link>
          </>
        ) : null}
      </p>
      {query.isPending ? (
        <div role="status">
          <span className="hidden-visually">{say('Loading the trial')}</span>
          <Skeleton height="640px" />
        </div>
      ) : null}
      {query.isError && !trial ? (
        <Notice
          tone={missing ? 'warn' : 'bad'}
          title={
            missing ? say('Trial not found, or its results are not released.') : say('The trial could not be loaded.')
          }
          onRetry={missing ? undefined : () => void query.refetch()}
        >
          {query.error.message}
        </Notice>
      ) : null}
      {trial ? (
        <>
          <div className={styles.headline}>
            <h1>{say('Debrief: {trial}', { trial: trial.case_title })}</h1>
            {trial.simulated ? <Badge tone="warn">{say('simulated')}</Badge> : null}
            <span className={styles.muted}>
              {personOf(trial)}, {formatDateTime(trial.started_utc_us)}, {formatDuration(trial.duration_s)}
            </span>
          </div>
          <Verdict trial={trial} />
          <ReleaseField trial={trial} may={may} />
          <Replay trial={trial} may={may} />
          <BreachCard trial={trial} />
          <Ratings trial={trial.id} may={mayRate} />
        </>
      ) : null}
    </div>
  );
}
