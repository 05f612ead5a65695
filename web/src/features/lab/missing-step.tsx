import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { atWork, effectsQuery, reportAddress, startDiagnosis, type Diagnosis, type LabRun, type Rig } from '@/api';
import { say, Sentence } from '@/language';
import { Badge, Button, Card, Notice, Skeleton } from '@/ui';
import { formatDuration, formatFigure, formatShare, share } from '@/units';
import { Headline, primaryUnit } from './comparison-parts';
import { Series, type Drawable } from './compare-step';
import { ErrorSteps } from './error-steps';
import styles from './lab.module.css';
import { Parameters } from './parameters';
import { Ranking } from './ranking';
import { RunState } from './run-state';
import { useRun } from './use-run';
import { verdictOf } from './verdict';
import { effectName, joined, workAddress } from './names';

interface Props {
  readonly model: string;
  readonly set: string;
  readonly rig: Rig;
}

const kTone = { good: 'good', warn: 'warn', bad: 'bad', accent: 'accent' } as const;

const stepName = (name: string) =>
  name === 'base'
    ? say('Refitted, no effect added')
    : name.replace(/\+ ?([\w:]+)/g, (_, id: string) => `+ ${effectName(id)}`);

type WeighedPrograms = NonNullable<Diagnosis['settle']>['programs'];

/** Simulated candidate recordings with what each promises, and as files that a station plays. */
function Programs({ programs }: { readonly programs: WeighedPrograms }) {
  if (programs.length === 0) return null;
  return (
    <ul>
      {programs.map(({ name, recording, duration_s, expected_gain, program }) => (
        <li key={name}>
          {recording}, {formatDuration(duration_s)}:{' '}
          {expected_gain === null
            ? '–'
            : say('gain {share}', { share: formatShare(share(Math.max(0, Math.min(expected_gain, 1)))) })}{' '}
          <a
            download={`${name.replaceAll(' ', '-')}.program.json`}
            href={`data:application/json,${encodeURIComponent(JSON.stringify(program))}`}
          >
            {say('Program')}
          </a>
        </li>
      ))}
    </ul>
  );
}

function Undetermined({ diagnosis }: { readonly diagnosis: Diagnosis }) {
  const { confounded, settle, notes } = diagnosis;
  if (confounded.length === 0 && !settle && notes.length === 0) return null;
  return (
    <Card title={say('What these measurements cannot determine')}>
      <div className={styles.stack}>
        {confounded.map(([a, b]) => (
          <p key={`${a} ${b}`}>
            <Sentence
              text="<strong>{one}</strong> and <strong>{other}</strong> cannot be distinguished with these measurements: the error is nearly the same with each."
              values={{ one: effectName(a), other: effectName(b) }}
              parts={{ strong: (words) => <strong>{words}</strong> }}
            />
          </p>
        ))}
        {settle ? (
          <Notice title={say('Recommended next recording')}>
            {settle.recording}{' '}
            {say('It would distinguish {effects}.', { effects: joined(settle.between.map(effectName)) })}{' '}
            {settle.expected_gain === null
              ? ''
              : say('In simulated recordings it increases the probability of the true answer by {share}.', {
                  share: formatShare(share(Math.min(settle.expected_gain, 1))),
                })}
            <Programs programs={settle.programs} />
          </Notice>
        ) : null}
        {notes.map((note) => (
          <p key={note} className={styles.muted}>
            {note}
          </p>
        ))}
      </div>
    </Card>
  );
}

function Found({ run, diagnosis, model, set, rig }: Props & { readonly run: LabRun; readonly diagnosis: Diagnosis }) {
  const effects = useQuery(effectsQuery(rig)).data?.effects ?? [];
  const unit = primaryUnit(run);
  const { tone, headline, detail } = verdictOf(diagnosis);
  const found = diagnosis.effects.map(({ id }) => effectName(id));
  const drawable: Drawable | null = run.comparisons
    ? {
        run,
        ...run.comparisons,
        rig,
        names: {
          before: found.length > 0 ? say('without effects') : say('refitted'),
          after: run.comparisons.after ? say('with {effects}', { effects: joined(found) }) : null,
        },
      }
    : null;
  return (
    <>
      <Card
        title={say('Verdict')}
        aside={
          <a href={reportAddress(run.id)} target="_blank" rel="noreferrer">
            {say('Report (new tab)')}
          </a>
        }
      >
        <div className={styles.verdict} data-tone={kTone[tone]} data-part="verdict">
          <p className={styles.headline}>{headline}</p>
          <p>{detail}</p>
          {run.model_ready && found.length > 0 ? (
            <p className={styles.buttons}>
              <Link href={workAddress(model, set, 'publish')} className={styles.solidLink}>
                {say('Add {effects} and publish', { effects: joined(found) })}
              </Link>
              <Link href={workAddress(model, set, 'add')}>{say('Try other effects or a custom formula')}</Link>
            </p>
          ) : null}
        </div>
      </Card>
      <Card
        title={say('Error by step')}
        aside={<Badge>{diagnosis.held_out === 'trials' ? say('held out by trial') : diagnosis.held_out}</Badge>}
      >
        <ErrorSteps
          steps={diagnosis.steps.map(({ model: name, ...errors }) => ({ name: stepName(name), ...errors }))}
          noise_floor={diagnosis.base.noise_floor}
          unit={unit}
        />
        <p className={styles.readable} data-part="why-two">
          <Sentence
            text="“Refitted, no effect added” has an error of {error}. <link>Compare</link> may show a larger error, because it uses the model as published; here, the parameters were first fitted to these measurements. Refitting corrects inaccurate parameters; the remaining error shows what the model lacks."
            values={{ error: formatFigure(diagnosis.base.rmse, unit) }}
            parts={{ link: (words) => <Link href={workAddress(model, set)}>{words}</Link> }}
          />
        </p>
      </Card>
      <Card title={say('Ranked effects')}>
        <Ranking
          ranking={diagnosis.ranking}
          effects={effects}
          unit={unit}
          without={diagnosis.base.held_out_rmse}
          addressToTry={(id) => `${workAddress(model, set, 'add')}?add=${encodeURIComponent(id)}`}
        />
      </Card>
      <Undetermined diagnosis={diagnosis} />
      {drawable ? (
        <Card
          title={drawable.names.after ? say('Residual without and with the effects') : say('Residual')}
          aside={<Badge>{say('fitted trials')}</Badge>}
        >
          <div className={styles.stack}>
            <Headline before={drawable.before} after={drawable.after} names={drawable.names} />
            <Series drawable={drawable} />
          </div>
        </Card>
      ) : null}
      <Card title={say('Fitted parameters')}>
        <Parameters estimates={diagnosis.parameters} />
      </Card>
    </>
  );
}

/** Searches for the effects that the model lacks. */
export function MissingStep({ model, set, rig }: Props) {
  const view = useRun({ kind: 'diagnosis', model, set, fits: () => true, start: () => startDiagnosis(model, set) });
  const effects = useQuery(effectsQuery(rig)).data?.effects ?? [];
  const { run } = view;
  if (view.error)
    return (
      <Notice tone="bad" title={say('The search failed.')} onRetry={view.retry}>
        {view.error.message}
      </Notice>
    );
  if (run === undefined) return <Skeleton height="200px" />;
  if (run === null) {
    return (
      <Card title={say('Which effect is missing?')}>
        <div className={styles.stack}>
          <p className={styles.readable}>
            {say(
              'First, the parameters of the model are fitted. Then every effect of the catalogue is added, alone and in combination, fitted on some trials and tested on the others. This takes seconds for probing and minutes for palpation; you can leave the page meanwhile.',
            )}
          </p>
          <div>
            <Button look="solid" onClick={view.begin} disabled={view.beginning}>
              {view.beginning ? say('Starting…') : say('Find missing effects')}
            </Button>
          </div>
        </div>
      </Card>
    );
  }
  if (run.diagnosis) return <Found run={run} diagnosis={run.diagnosis} model={model} set={set} rig={rig} />;
  return (
    <>
      <Card title={say('Which effect is missing?')}>
        <RunState run={run} what={say('The search')} again={view.begin} />
      </Card>
      {run.ranking && atWork(run) ? (
        <Card title={say('Preliminary ranking')} aside={<Badge tone="accent">{say('in progress')}</Badge>}>
          <Ranking
            ranking={run.ranking}
            effects={effects}
            unit={primaryUnit(run)}
            without={null}
            addressToTry={(id) => `${workAddress(model, set, 'add')}?add=${encodeURIComponent(id)}`}
          />
        </Card>
      ) : null}
    </>
  );
}
