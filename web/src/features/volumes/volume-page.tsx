import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import { refuseVolume, releaseVolume, sessionQuery, sourceVolumesQuery, type SourceVolume } from '@/api';
import { say } from '@/language';
import { Button, Card, Facts, Notice, ReasonDialog, Skeleton, useTitle } from '@/ui';
import { formatBytes, formatCount, formatDateTime, formatFigure, formatLength, metre } from '@/units';
import { Viewer } from './viewer';
import { kStates } from './volumes-page';
import styles from './volumes.module.css';

/** Decides about a held volume, for those who may. */
function Deciding({ volume }: { readonly volume: SourceVolume }) {
  const client = useQueryClient();
  const [looked, setLooked] = useState(false);
  const [refusing, setRefusing] = useState(false);
  const refresh = () => client.invalidateQueries({ queryKey: sourceVolumesQuery.queryKey });
  const released = useMutation({ mutationFn: () => releaseVolume(volume.id), onSuccess: refresh });
  return (
    <Card title={say('Release or refuse')}>
      <div className={styles.stack}>
        {volume.suspicions.length === 0 ? null : (
          <Notice tone="warn" title={say('The pixels may show text or a face. Look there:')}>
            <ul className={styles.suspicions}>
              {volume.suspicions.map((one) => (
                <li key={one}>{one}</li>
              ))}
            </ul>
          </Notice>
        )}
        <label className={styles.check}>
          <input type="checkbox" checked={looked} onChange={(event) => setLooked(event.target.checked)} />{' '}
          {say('I looked through the slices and saw no text and no face.')}
        </label>
        <div className={styles.buttons}>
          <Button look="solid" disabled={!looked || released.isPending} onClick={() => released.mutate()}>
            {say('Release for making cases')}
          </Button>
          <Button onClick={() => setRefusing(true)}>{say('Refuse…')}</Button>
        </div>
        {released.isError ? (
          <Notice tone="bad" title={say('The volume was not released.')}>
            {released.error.message}
          </Notice>
        ) : null}
        {refusing ? (
          <ReasonDialog
            title={say('Refuse {volume}', { volume: volume.name })}
            text={say('The server removes the voxels and keeps the record with your reason. This cannot be undone.')}
            action={say('Refuse the volume')}
            reasonNeeded
            onAction={async (reason) => {
              await refuseVolume(volume.id, reason);
              await refresh();
            }}
            onClose={() => setRefusing(false)}
          />
        ) : null}
      </div>
    </Card>
  );
}

function Record({ volume }: { readonly volume: SourceVolume }) {
  const { dims, spacing_m, range, decided_utc_us } = volume;
  const decided = decided_utc_us === null ? '' : `, ${formatDateTime(decided_utc_us)}`;
  return (
    <Card title={say('Record')}>
      <Facts
        facts={[
          { name: say('State'), value: say(kStates[volume.state]) + decided },
          ...(volume.released_by === null ? [] : [{ name: say('Released by'), value: volume.released_by }]),
          ...(volume.reason === '' ? [] : [{ name: say('Reason'), value: volume.reason }]),
          { name: say('Source'), value: volume.source },
          {
            name: say('Format'),
            value: volume.modality === null ? volume.format : `${volume.format}, ${volume.modality}`,
          },
          { name: say('Voxels'), value: dims.map(formatCount).join(' × ') },
          { name: say('Voxel size'), value: spacing_m.map((one) => formatLength(metre(one), 2)).join(' × ') },
          {
            name: say('CT values'),
            value: say('{low} to {high}', { low: formatFigure(range[0]), high: formatFigure(range[1]) }),
          },
          { name: say('Size'), value: formatBytes(volume.size_bytes) },
          {
            name: say('Uploaded'),
            value: say('{date} by {name}', { date: formatDateTime(volume.made_utc_us), name: volume.made_by }),
          },
          ...volume.notes.map((note) => ({ name: say('Note'), value: note })),
        ]}
      />
    </Card>
  );
}

/** One volume: its pictures, its record, and the decision about it. */
export function VolumePage({ id }: { readonly id: string }) {
  const query = useQuery(sourceVolumesQuery);
  const session = useQuery({ ...sessionQuery, enabled: false }).data;
  const volume = query.data?.volumes.find((one) => one.id === id);
  useTitle(volume?.name ?? say('Volume'));
  const decides = session?.role === 'admin' || session?.role === 'director';
  const sees =
    volume?.state === 'released' || (volume?.state === 'held' && (decides || session?.name === volume.made_by));
  return (
    <div className={styles.page}>
      <p>
        <Link href="/volumes">← {say('Volumes')}</Link>
      </p>
      <h1>{volume?.name ?? say('Volume')}</h1>
      {query.isError ? (
        <Notice tone="bad" title={say('The volume could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {query.isPending ? <Skeleton height="640px" /> : null}
      {query.data && !volume ? <Notice tone="warn" title={say('There is no such volume.')} /> : null}
      {volume?.state === 'held' && !sees ? (
        <Notice title={say('This volume waits for review.')}>
          {say('A director or an administrator looks at its pictures first.')}
        </Notice>
      ) : null}
      {volume && sees ? <Viewer volume={volume} /> : null}
      {volume?.state === 'held' && decides ? <Deciding volume={volume} /> : null}
      {volume?.state === 'released' ? (
        <p>
          <Link href={`/cases/new/${volume.id}`}>{say('Make a case from this volume')}</Link>
        </p>
      ) : null}
      {volume ? <Record volume={volume} /> : null}
    </div>
  );
}
