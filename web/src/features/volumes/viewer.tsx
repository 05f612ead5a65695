import { useQuery } from '@tanstack/react-query';
import { useMemo, useState } from 'react';
import { boundsOf, sliceQuery, type SlicePlane, type SourceVolume, type Vec3 } from '@/api';
import { SliceView, type SliceMark } from '@/charts';
import { marked, say } from '@/language';
import { Button, Card, Field, Notice, Select } from '@/ui';
import { formatLength, metre } from '@/units';
import styles from './volumes.module.css';

const kPlanes: readonly { plane: SlicePlane; name: string; axis: 0 | 1 | 2; ends: readonly [string, string] }[] = [
  { plane: 'axial', name: marked('Axial'), axis: 2, ends: [marked('feet'), marked('head')] },
  { plane: 'coronal', name: marked('Coronal'), axis: 1, ends: [marked('front'), marked('back')] },
  { plane: 'sagittal', name: marked('Sagittal'), axis: 0, ends: [marked('right'), marked('left')] },
];
const kWindows = {
  bone: { text: marked('Bone'), low: -200, high: 1100 },
  soft: { text: marked('Soft tissue'), low: -160, high: 240 },
  lung: { text: marked('Lung'), low: -1350, high: 150 },
  wide: { text: marked('Wide'), low: -1000, high: 2000 },
} as const;
type WindowName = keyof typeof kWindows | 'own';
const kWindowNames = ['bone', 'soft', 'lung', 'wide'] as const;
const kZooms = [1, 2, 4] as const;
const kPitch_m = 0.0005;

interface Ruler {
  readonly from: Vec3;
  readonly to: Vec3 | null;
}
type End = 'start' | 'end';

function marksOf(ruler: Ruler | null): SliceMark[] {
  if (!ruler) return [];
  const start: SliceMark = { id: 'start', at: ruler.from, look: 'entry' };
  if (!ruler.to) return [start];
  return [
    { id: 'ruler', at: ruler.from, to: ruler.to, look: 'tract', wide: 0.8 },
    { id: 'end', at: ruler.to, look: 'target' },
    start,
  ];
}

const distance = (a: Vec3, b: Vec3) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

function OnePlane({
  volume,
  where: { plane, name, axis, ends },
  window,
  zoom,
  focus,
  ruler,
  chosen,
  onFocus,
  onPlace,
}: {
  readonly volume: SourceVolume;
  readonly where: (typeof kPlanes)[number];
  readonly window: { readonly low: number; readonly high: number };
  readonly zoom: number;
  readonly focus: Vec3;
  readonly ruler: Ruler | null;
  readonly chosen: End;
  readonly onFocus: (at: Vec3) => void;
  readonly onPlace: (id: string, at: Vec3, done: boolean) => void;
}) {
  const { low, high } = useMemo(() => boundsOf(volume), [volume]);
  const marks = useMemo(() => marksOf(ruler), [ruler]);
  const at = Math.round(Math.min(Math.max(focus[axis], low[axis]), high[axis]) * 1e6) / 1e6;
  const query = useQuery(sliceQuery(volume.id, plane, at, window));
  return (
    <div>
      {query.isError ? (
        <Notice tone="bad" title={say('This slice could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <SliceView
        name={name}
        picture={query.data ?? null}
        late={query.isPlaceholderData}
        zoom={zoom}
        at_m={at}
        from_m={low[axis]}
        to_m={high[axis]}
        ends={[say(ends[0]), say(ends[1])]}
        marks={marks}
        chosen={chosen}
        onAt={(to) => onFocus([axis === 0 ? to : focus[0], axis === 1 ? to : focus[1], axis === 2 ? to : focus[2]])}
        onPlace={onPlace}
      />
    </div>
  );
}

/** The volume in three planes: window, zoom, and a ruler between two points. */
export function Viewer({ volume }: { readonly volume: SourceVolume }) {
  const [chosen, setChosen] = useState<WindowName>('bone');
  const [own, setOwn] = useState({ low: '-200', high: '1100' });
  const [zoom, setZoom] = useState('1');
  const [focus, setFocus] = useState<Vec3>(() => {
    const { low, high } = boundsOf(volume);
    const middle = (i: 0 | 1 | 2) => Math.round((low[i] + high[i]) / 2 / kPitch_m) * kPitch_m;
    return [middle(0), middle(1), middle(2)];
  });
  const [ruler, setRuler] = useState<Ruler | null>(null);
  const [end, setEnd] = useState<End>('start');
  const typed = { low: Number(own.low), high: Number(own.high) };
  const valid = own.low.trim() !== '' && own.high.trim() !== '' && typed.low < typed.high;
  const window = chosen !== 'own' ? kWindows[chosen] : valid ? typed : kWindows.bone;
  const place = (id: string, at: Vec3, done: boolean) => {
    if (id === 'start') setRuler({ from: at, to: ruler?.to ?? null });
    if (id === 'end' && ruler) setRuler({ from: ruler.from, to: at });
    if (done) setEnd(id === 'start' ? 'end' : 'start');
  };
  return (
    <Card title={say('Slices')}>
      <div className={styles.stack}>
        <div className={styles.tools}>
          <Select
            label={say('Window')}
            value={chosen}
            onChange={(event) => setChosen(kWindowNames.find((one) => one === event.target.value) ?? 'own')}
            options={[
              ...kWindowNames.map((value) => ({ value, text: say(kWindows[value].text) })),
              { value: 'own', text: say('Other…') },
            ]}
          />
          {chosen === 'own' ? (
            <>
              <Field
                label={say('Black at, CT value')}
                inputMode="numeric"
                value={own.low}
                onChange={(event) => setOwn({ ...own, low: event.target.value })}
              />
              <Field
                label={say('White at, CT value')}
                inputMode="numeric"
                value={own.high}
                error={valid ? '' : say('More than black is expected.')}
                onChange={(event) => setOwn({ ...own, high: event.target.value })}
              />
            </>
          ) : null}
          <Select
            label={say('Zoom')}
            value={zoom}
            onChange={(event) => setZoom(event.target.value)}
            options={kZooms.map((value) => ({ value: String(value), text: `${value} ×` }))}
          />
          <p className={styles.ruler} role="status">
            {say('Ruler')}:{' '}
            <strong>
              {ruler?.to ? formatLength(metre(distance(ruler.from, ruler.to)), 1) : say('click two points')}
            </strong>
          </p>
          <Button
            disabled={ruler === null}
            onClick={() => {
              setRuler(null);
              setEnd('start');
            }}
          >
            {say('Clear ruler')}
          </Button>
        </div>
        <div className={styles.slices}>
          {kPlanes.map((where) => (
            <OnePlane
              key={where.plane}
              volume={volume}
              where={where}
              window={window}
              zoom={Number(zoom)}
              focus={focus}
              ruler={ruler}
              chosen={end}
              onFocus={setFocus}
              onPlace={place}
            />
          ))}
        </div>
      </div>
    </Card>
  );
}
