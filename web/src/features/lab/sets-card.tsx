import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { lazy, Suspense, useState } from 'react';
import { addMeasurements, measurementsQuery, type MeasurementSet } from '@/api';
import { say, Sentence } from '@/language';
import { Badge, Card, DropZone, Notice, Skeleton, Term, type Dropped } from '@/ui';
import { formatCount, formatDateTime, isoDateTime } from '@/units';
import styles from './lab.module.css';
import { setFacts } from './names';
import { pack, problemsOf } from './zip-files';

/** With the readers of recordings, which few visits need. */
const RecordingForm = lazy(() => import('./recording/recording-form'));

/** The one MCAP recording that was dropped. */
const recordingIn = ([only, ...others]: readonly Dropped[]) =>
  only && others.length === 0 && /\.mcap$/i.test(only.file.name) ? only.file : null;

interface Props {
  readonly chosen: string | null;
  readonly choose: (id: string) => void;
}

/** All errors with file and line. */
function Problems({ message }: { readonly message: string }) {
  const problems = problemsOf(message);
  return (
    <Notice tone="bad" title={say('The measurements were not added.')}>
      <table className={styles.problems}>
        <thead>
          <tr>
            <th scope="col">{say('File')}</th>
            <th scope="col" className={styles.number}>
              {say('Line')}
            </th>
            <th scope="col">{say('Error')}</th>
          </tr>
        </thead>
        <tbody>
          {problems.map(({ file, line, what }, i) => (
            <tr key={i}>
              <td>{file === '' ? '–' : file}</td>
              <td className={styles.number}>{line === null ? '–' : formatCount(line)}</td>
              <td>{what}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </Notice>
  );
}

function SetRow({
  set,
  chosen,
  choose,
}: {
  readonly set: MeasurementSet;
  readonly chosen: boolean;
  readonly choose: () => void;
}) {
  return (
    <label className={styles.choice}>
      <input type="radio" name="set" checked={chosen} onChange={choose} />
      <span className={styles.choiceText}>
        <span className={styles.choiceName}>
          {set.name} {set.simulated === true ? <Badge tone="warn">{say('simulated')}</Badge> : null}
        </span>
        <span className={styles.muted}>{setFacts(set)}</span>
      </span>
      <span className={styles.muted}>
        <time dateTime={isoDateTime(set.made_utc_us)}>{formatDateTime(set.made_utc_us)}</time>, {set.made_by}
      </span>
    </label>
  );
}

export function SetsCard({ chosen, choose }: Props) {
  const client = useQueryClient();
  const query = useQuery(measurementsQuery);
  const [recording, setRecording] = useState<File | null>(null);
  const onAdded = async (set: MeasurementSet) => {
    setRecording(null);
    await client.invalidateQueries({ queryKey: measurementsQuery.queryKey });
    choose(set.id);
  };
  const sent = useMutation({
    mutationFn: async (files: readonly Dropped[]) => {
      const { name, zip } = await pack(files);
      return addMeasurements(name, zip);
    },
    onSuccess: onAdded,
  });
  const sets = query.data?.measurements;
  return (
    <Card title={say('1 · Measurements')}>
      <div className={styles.stack}>
        <DropZone
          label={say('New measurements')}
          folder={say('A folder with set.json')}
          files={say('A zip file, set.json with its CSV files, or an .mcap recording')}
          choose={say('Choose file')}
          onFiles={(files) => {
            const dropped = recordingIn(files);
            setRecording(dropped);
            sent.reset();
            if (!dropped) sent.mutate(files);
          }}
          busy={sent.isPending ? say('Packing, uploading and checking the files…') : null}
        >
          <Sentence
            text="Drop a folder or a zip file here: <code>set.json</code> and one CSV file per trial, in the format <term>tractus-measurements/1</term>. Or an <code>.mcap</code> recording, as ROS 2 writes it."
            parts={{
              code: (words) => <code>{words}</code>,
              term: (words) => (
                <Term
                  definition={say(
                    'File format for measurements: set.json names the rig and the trials; each CSV file has a header whose column names end in SI units, such as t_s, x_m, fz_N.',
                  )}
                >
                  {words}
                </Term>
              ),
            }}
          />
        </DropZone>
        {recording ? (
          <Suspense fallback={<Skeleton height="120px" />}>
            <RecordingForm
              key={`${recording.name} ${recording.size}`}
              file={recording}
              onAdded={(set) => void onAdded(set)}
              onClose={() => setRecording(null)}
            />
          </Suspense>
        ) : null}
        {sent.isError ? <Problems message={sent.error.message} /> : null}
        {query.isError ? (
          <Notice tone="bad" title={say('The list could not be loaded.')} onRetry={() => void query.refetch()}>
            {query.error.message}
          </Notice>
        ) : null}
        <fieldset className={styles.choices}>
          <legend className="hidden-visually">{say('Measurement sets, newest first')}</legend>
          {sets?.map((set) => (
            <SetRow key={set.id} set={set} chosen={set.id === chosen} choose={() => choose(set.id)} />
          ))}
          {sets?.length === 0 ? (
            <p className={styles.muted}>{say('No measurements yet. Add the first set above.')}</p>
          ) : null}
        </fieldset>
      </div>
    </Card>
  );
}
