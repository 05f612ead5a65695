import { useMemo, useState } from 'react';
import type { Trial } from '@/api';
import { SignalChart, whole, type Cursor, type Mark, type Range } from '@/charts';
import { say } from '@/language';
import { Button, Notice, usePalette } from '@/ui';
import { marksOf, setOf, summaryOf } from './panels';
import { useSignals } from './use-signals';

const kUsualWidth_px = 1200;

interface Props {
  readonly trial: Trial;
  readonly cursor: Cursor;
  /** Moments that are known from elsewhere than the events. */
  readonly further?: readonly Mark[];
}

const kNone: readonly Mark[] = [];

export function SignalsPanel({ trial, cursor, further = kNone }: Props) {
  const [range, setRange] = useState<Range>(() => whole(trial.duration_s));
  const [width, setWidth] = useState(kUsualWidth_px);
  const palette = usePalette();
  const { panels, channels, note } = useMemo(() => setOf(trial.rig), [trial.rig]);
  const { detail, overview, error, retry } = useSignals(trial, channels, range, width);
  const marks = useMemo(() => [...marksOf(trial), ...further], [trial, further]);
  const summary = useMemo(() => summaryOf(trial, overview), [trial, overview]);
  if (!(trial.duration_s > 0)) return <p>{say('No sample was recorded.')}</p>;
  return (
    <>
      {error ? (
        <Notice tone="bad" title={say('Part of the signals could not be loaded.')} onRetry={retry}>
          {error.message}
        </Notice>
      ) : null}
      <SignalChart
        panels={panels}
        detail={detail}
        overview={overview}
        duration_s={trial.duration_s}
        range={range}
        marks={marks}
        cursor={cursor}
        palette={palette}
        summary={summary}
        note={note}
        onRange={setRange}
        onWidth={setWidth}
        button={(label, sign, press, disabled) => (
          <Button label={label} onClick={press} disabled={disabled}>
            {sign}
          </Button>
        )}
      />
    </>
  );
}
