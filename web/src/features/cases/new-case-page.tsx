import { useQuery } from '@tanstack/react-query';
import { useEffect, useReducer, useState } from 'react';
import { Link, useSearch } from 'wouter';
import {
  boundsOf,
  plannedTractQuery,
  sourceVolumesQuery,
  volumeBoneQuery,
  type Preview,
  type SourceVolume,
  type Vec3,
  type Window,
} from '@/api';
import { PlanView } from '@/charts';
import { marked, say } from '@/language';
import { Button, Card, Notice, Select, Skeleton, usePalette, useTitle, useSettled } from '@/ui';
import { BrushFields } from './brush';
import styles from './cases.module.css';
import { PlannedCertificate } from './certificate';
import { BreachFields, PointFields } from './fields';
import { Findings, Peaks } from './findings';
import { Make } from './make';
import { draw, fromAddress, toAddress, requestOf, type End, type Tool } from './plan';
import { Slices } from './slices';
import { Walls } from './walls';

const kWindows: Record<string, { readonly text: string; readonly window: Window }> = {
  bone: { text: marked('Bone'), window: { low: -200, high: 1100 } },
  wide: { text: marked('Wide'), window: { low: -1000, high: 2000 } },
  soft: { text: marked('Soft tissue'), window: { low: -160, high: 240 } },
};

const kBrush_m = 0.003;

function middleOf(block: Preview): Vec3 {
  const { low, high } = boundsOf(block);
  return [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2];
}

function Workbench({ volume, block }: { readonly volume: SourceVolume; readonly block: Preview }) {
  const search = useSearch();
  const palette = usePalette();
  const [{ plan, past, future }, step] = useReducer(draw, search, (address) => ({
    plan: fromAddress(address),
    past: [],
    future: [],
  }));
  const [tool, setTool] = useState<Tool>(plan.entry ? 'target' : 'entry');
  const [brush_m, setBrush] = useState(kBrush_m);
  const [focus, setFocus] = useState<Vec3>(() => plan.entry ?? middleOf(block));
  const [dragging, setDragging] = useState(false);
  const [window_, setWindow] = useState('bone');
  const settled = useSettled(plan, 250);
  const request = requestOf(settled);
  const answer = useQuery(plannedTractQuery(volume.id, request));
  const found = request ? answer.data : undefined;
  const looking = answer.isFetching || settled !== plan;
  useEffect(() => {
    window.history.replaceState(null, '', `?${toAddress(settled)}`);
  }, [settled]);

  const filled = plan.preparation === 'filled';
  const chosen: Tool = filled || tool === 'target' ? tool : 'entry'; // only filled bone has an envelope to correct

  const place = (end: End, at: Vec3, done: boolean) => {
    step({ kind: 'change', to: end === 'entry' ? { entry: at } : { target: at }, passing: dragging });
    setDragging(!done);
    setTool(end);
    if (!done) return;
    setFocus(at);
    if (end === 'entry' && !plan.target) setTool('target');
  };
  const type = (end: End, at: Vec3) => {
    step({ kind: 'change', to: end === 'entry' ? { entry: at } : { target: at } });
    setFocus(at);
  };
  return (
    <div className={styles.bench}>
      <div className={styles.left}>
        <Card
          title={say('Slices')}
          aside={
            <span className={styles.tools}>
              <Select
                label={<span className="hidden-visually">{say('Window')}</span>}
                value={window_}
                options={Object.entries(kWindows).map(([value, { text }]) => ({ value, text: say(text) }))}
                onChange={(event) => setWindow(event.target.value)}
              />
              <Button onClick={() => step({ kind: 'undo' })} disabled={past.length === 0}>
                {say('Undo')}
              </Button>
              <Button onClick={() => step({ kind: 'redo' })} disabled={future.length === 0}>
                {say('Redo')}
              </Button>
            </span>
          }
        >
          <Slices
            volume={volume.id}
            block={block}
            window={kWindows[window_]?.window ?? { low: -200, high: 1100 }}
            plan={plan}
            found={found}
            tool={chosen}
            brush_m={brush_m}
            focus={focus}
            onFocus={setFocus}
            onPlace={place}
            onBrush={(brush, at_m, first) =>
              step(
                brush === 'erase'
                  ? { kind: 'erase', at_m, radius_m: brush_m, passing: !first }
                  : {
                      kind: 'paint',
                      mark: { at_m: [...at_m], radius_m: brush_m, bone: brush === 'bone' },
                      passing: !first,
                    },
              )
            }
          />
        </Card>
        <div className={styles.pair}>
          <Card title={say('3-D view')}>
            <PlanView
              tract={found?.tract ?? null}
              breach={found?.breach ?? null}
              bone={block}
              palette={palette}
              summary={say('The bone with the planned tract and its breach.')}
              button={(label, text, press, pressed) => (
                <Button label={label} onClick={press} {...(pressed === undefined ? {} : { pressed })}>
                  {text}
                </Button>
              )}
            />
          </Card>
          <Card title={say('Walls along the tract')}>
            {found?.tract ? (
              <Walls found={found} />
            ) : (
              <p className={`${styles.muted} ${styles.tall}`}>
                {say('Place both ends of the tract to see the thickness of the walls.')}
              </p>
            )}
          </Card>
        </div>
        {found?.tract ? (
          <Card title={say('What can be felt')}>
            <PlannedCertificate volume={volume.id} request={request} length_m={found.length_m} />
          </Card>
        ) : null}
      </div>
      <Card title={say('Tract')} className={styles.side ?? ''}>
        <div className={styles.stack}>
          <fieldset className={styles.ends}>
            <legend className="hidden-visually">{say('What a click in a slice does')}</legend>
            {(['entry', 'target'] as const).map((end) => (
              <PointFields
                key={end}
                end={end}
                at={plan[end]}
                chosen={chosen === end}
                onChoose={() => {
                  setTool(end);
                  const at = plan[end];
                  if (at) setFocus(at);
                }}
                onAt={(at) => type(end, at)}
              />
            ))}
            {filled ? (
              <BrushFields
                chosen={chosen}
                radius_m={brush_m}
                marks={plan.marks.length}
                onChoose={setTool}
                onRadius={setBrush}
                onRemove={() => step({ kind: 'change', to: { marks: [] } })}
              />
            ) : null}
          </fieldset>
          <BreachFields
            plan={plan}
            length_m={found?.length_m ?? null}
            onBreach={(breach) => step({ kind: 'change', to: { breach } })}
            onWhole={(whole) => step({ kind: 'change', to: { whole, breach: null } })}
            onPreparation={(preparation) => step({ kind: 'change', to: { preparation } })}
          />
          {answer.isError ? (
            <Notice tone="bad" title={say('The plan could not be checked.')} onRetry={() => void answer.refetch()}>
              {answer.error.message}
            </Notice>
          ) : (
            <Findings plan={plan} found={found} looking={looking} />
          )}
          {found?.calibration && !answer.isError ? <Peaks calibration={found.calibration} /> : null}
          <Make
            volume={volume.id}
            plan={plan}
            ready={found?.tract !== null && found?.problems.length === 0 && !looking}
          />
        </div>
      </Card>
    </div>
  );
}

function Chosen({ volume }: { readonly volume: SourceVolume }) {
  const block = useQuery(volumeBoneQuery(volume.id));
  if (block.isError)
    return (
      <Notice tone="bad" title={say('The volume could not be loaded.')} onRetry={() => void block.refetch()}>
        {block.error.message}
      </Notice>
    );
  return block.data ? (
    <Workbench volume={volume} block={block.data} />
  ) : (
    <div role="status">
      <span className="hidden-visually">{say('Loading the volume')}</span>
      <Skeleton height="640px" />
    </div>
  );
}

/** From a released volume to a case: tract, breach, title. */
export function NewCasePage({ volume: id }: { readonly volume: string }) {
  const volumes = useQuery(sourceVolumesQuery);
  const volume = volumes.data?.volumes.find((one) => one.id === id);
  useTitle(say('New case'));
  return (
    <div className={styles.page}>
      <p>
        <Link href="/cases">← {say('Cases')}</Link>
      </p>
      <div>
        <h1>{volume ? say('New case from {name}', { name: volume.name }) : say('New case')}</h1>
        <p className={styles.lead}>
          {say(
            'Place the tract of a pedicle screw in the bone and choose where it breaches a wall. Coordinates are in millimetres in the patient’s frame: x to the left, y to the back, z upwards.',
          )}
        </p>
      </div>
      {volumes.isError ? (
        <Notice tone="bad" title={say('The volumes could not be loaded.')} onRetry={() => void volumes.refetch()}>
          {volumes.error.message}
        </Notice>
      ) : null}
      {volumes.isPending ? (
        <div role="status">
          <span className="hidden-visually">{say('Loading')}</span>
          <Skeleton height="640px" />
        </div>
      ) : null}
      {volumes.data && !volume ? (
        <Notice tone="warn" title={say('Volume not found.')}>
          {say('It may have been rejected.')}
        </Notice>
      ) : null}
      {volume && volume.state !== 'released' ? (
        <Notice tone="warn" title={say('This volume is not released.')}>
          {say('An administrator or the programme director must review it first.')}
        </Notice>
      ) : null}
      {volume?.state === 'released' ? <Chosen volume={volume} /> : null}
    </div>
  );
}
