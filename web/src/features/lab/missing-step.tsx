import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { atWork, effectsQuery, reportAddress, startDiagnosis, type Diagnosis, type LabRun, type Rig } from '@/api';
import { Badge, Button, Card, Notice, Skeleton } from '@/ui';
import { formatFigure, formatShare, share } from '@/units';
import { Headline, primaryOf } from './comparison-parts';
import { Series, type Drawable } from './compare-step';
import { Falls } from './falls';
import styles from './lab.module.css';
import { Parameters } from './parameters';
import { Ranking } from './ranking';
import { RunState } from './run-state';
import { useRun } from './use-run';
import { verdictOf } from './verdict';
import { channelUnit, effectName, joined, workAddress } from './words';

interface Props { readonly model: string; readonly set: string; readonly rig: Rig }

const kTone = { good: 'good', warn: 'warn', bad: 'bad', accent: 'accent' } as const;

const stepName = (name: string) => (name === 'base' ? 'Refitted alone' : name.replace(/\+ ?([\w:]+)/g, (_, id: string) => `+ ${effectName(id)}`));

function Undecided({ diagnosis }: { readonly diagnosis: Diagnosis }) {
  const { confounded, settle, notes } = diagnosis;
  if (confounded.length === 0 && !settle && notes.length === 0) return null;
  return (
    <Card title="What these measurements cannot tell">
      <div className={styles.stack}>
        {confounded.map(([a, b]) => <p key={`${a} ${b}`}><strong>{effectName(a)}</strong> and <strong>{effectName(b)}</strong> look alike here: each leaves nearly the same error.</p>)}
        {settle ? (
          <Notice title="The recording to make next">{settle.recording} It would decide between {joined(settle.between.map(effectName))}{settle.expected_gain === null ? '.' : ` with a probability of ${formatShare(share(Math.min(settle.expected_gain, 1)))}.`}</Notice>
        ) : null}
        {notes.map((note) => <p key={note} className={styles.muted}>{note}</p>)}
      </div>
    </Card>
  );
}

function Found({ run, diagnosis, model, set, rig }: Props & { readonly run: LabRun; readonly diagnosis: Diagnosis }) {
  const effects = useQuery(effectsQuery(rig)).data?.effects ?? [];
  const primary = run.comparisons ? primaryOf(run.comparisons.before)?.name ?? 'force_N' : 'force_N';
  const unit = channelUnit(primary);
  const { tone, headline, detail } = verdictOf(diagnosis, unit);
  const found = diagnosis.effects.map(({ id }) => effectName(id));
  const drawable: Drawable | null = run.comparisons
    ? { run, ...run.comparisons, rig, names: { before: found.length > 0 ? 'without' : 'refitted', after: run.comparisons.after ? `with ${joined(found)}` : null } } : null;
  return (
    <>
      <Card title="Verdict" aside={<a href={reportAddress(run.id)} target="_blank" rel="noreferrer">Report to keep (opens a page)</a>}>
        <div className={styles.verdict} data-tone={kTone[tone]} data-part="verdict">
          <p className={styles.headline}>{headline}</p>
          <p>{detail}</p>
          {run.model_ready && found.length > 0 ? <p className={styles.buttons}><Link href={workAddress(model, set, 'publish')} className={styles.solidLink}>Add {joined(found)} and publish</Link><Link href={workAddress(model, set, 'add')}>Try others or a formula of your own</Link></p> : null}
        </div>
      </Card>
      <Card title="The error falls"><Falls steps={diagnosis.steps.map(({ model: name, ...errors }) => ({ name: stepName(name), ...errors }))} noise_floor={diagnosis.base.noise_floor} unit={unit} />
        <p className={styles.readable} data-part="why-two">“Refitted alone” is {formatFigure(diagnosis.base.rmse, unit)}, and <Link href={workAddress(model, set)}>Compare</Link> may show more: there the model stands as it was published, here its own numbers were fitted to these measurements first. What a refit mends is a number that was off; what it leaves is what the model lacks.</p>
      </Card>
      <Card title="Effects, ranked"><Ranking ranking={diagnosis.ranking} effects={effects} unit={unit} without={diagnosis.base.held_out_rmse} addressToTry={(id) => `${workAddress(model, set, 'add')}?add=${encodeURIComponent(id)}`} /></Card>
      <Undecided diagnosis={diagnosis} />
      {drawable ? <Card title={drawable.names.after ? 'What is left, without and with' : 'What is left'} aside={<Badge>{diagnosis.held_out === 'trials' ? 'held out by trial' : diagnosis.held_out}</Badge>}><div className={styles.stack}><Headline before={drawable.before} after={drawable.after} names={drawable.names} /><Series drawable={drawable} /></div></Card> : null}
      <Card title="Fitted numbers"><Parameters estimates={diagnosis.parameters} /></Card>
    </>
  );
}

/** Which effect the model lacks. */
export function MissingStep({ model, set, rig }: Props) {
  const view = useRun({ kind: 'diagnosis', model, set, fits: () => true, start: () => startDiagnosis(model, set) });
  const effects = useQuery(effectsQuery(rig)).data?.effects ?? [];
  const { run } = view;
  if (view.error) return <Notice tone="bad" title="The search could not be made." onRetry={view.retry}>{view.error.message}</Notice>;
  if (run === undefined) return <Skeleton height="200px" />;
  if (run === null) {
    return (
      <Card title="Which effect is missing?">
        <div className={styles.stack}>
          <p className={styles.readable}>The model’s own numbers are fitted first. Then every effect of the catalogue is added by itself and with others, fitted on some trials and judged on the rest. Seconds for probing, minutes for palpation; you may leave the page meanwhile.</p>
          <div><Button look="solid" onClick={view.begin} disabled={view.beginning}>{view.beginning ? 'Asking…' : 'Find what is missing'}</Button></div>
        </div>
      </Card>
    );
  }
  if (run.diagnosis) return <Found run={run} diagnosis={run.diagnosis} model={model} set={set} rig={rig} />;
  return (
    <>
      <Card title="Which effect is missing?"><RunState run={run} what="The search" again={view.begin} /></Card>
      {run.ranking && atWork(run) ? (
        <Card title="First ranking" aside={<Badge tone="accent">still being judged</Badge>}>
          <Ranking ranking={run.ranking} effects={effects} unit="N" without={null} addressToTry={(id) => `${workAddress(model, set, 'add')}?add=${encodeURIComponent(id)}`} />
        </Card>
      ) : null}
    </>
  );
}
