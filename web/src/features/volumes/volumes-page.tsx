import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import { Link, useLocation } from 'wouter';
import { addVolume, sourceVolumesQuery, type SourceVolume } from '@/api';
import { marked, say } from '@/language';
import { Badge, Button, Card, DataTable, DropZone, Field, Notice, Progress, useTitle, type Dropped } from '@/ui';
import { formatBytes, formatCount, formatDateTime, formatShare, share } from '@/units';
import { opened } from './archive';
import { dicomSeries, type DicomSeries } from './dicom-series';
import { nameFrom, pack } from './pack';
import { FromPacs } from './pacs';
import { SeriesChoice } from './series-choice';
import styles from './volumes.module.css';

const kTones = { held: 'warn', released: 'good', refused: 'bad' } as const;
export const kStates = {
  held: marked('waits for review'),
  released: marked('released'),
  refused: marked('refused'),
} as const;

function Upload() {
  const client = useQueryClient();
  const [, go] = useLocation();
  const [files, setFiles] = useState<readonly Dropped[]>([]);
  const [chosen, setChosen] = useState<DicomSeries | null>(null);
  const read = useMutation({
    mutationFn: async (dropped: readonly Dropped[]) => dicomSeries(await opened(dropped)),
  });
  const several = (read.data?.length ?? 0) > 1;
  const parts = several ? (chosen?.slices ?? []) : files;
  const [name, setName] = useState('');
  const [source, setSource] = useState('');
  const [gone, setGone] = useState<number | null>(null);
  const sent = useMutation({
    mutationFn: async () => {
      setGone(null);
      const file = await pack(parts);
      return addVolume(name.trim(), source.trim(), file, setGone);
    },
    onSuccess: async (made) => {
      await client.invalidateQueries({ queryKey: sourceVolumesQuery.queryKey });
      go(`/volumes/${made.id}`);
    },
  });
  const counted = parts.length > 0 ? parts : files;
  const size = counted.reduce((sum, { file }) => sum + file.size, 0);
  const phase =
    gone === null
      ? say('Packing the files…')
      : gone < 1
        ? say('Uploading: {share} of the file', { share: formatShare(share(gone)) })
        : say('The server reads the volume and takes the patient’s identity out…');
  return (
    <Card title={say('Upload a volume')}>
      <div className={styles.stack}>
        <DropZone
          label={say('New volume')}
          folder={say('A folder of DICOM slices')}
          files={say('A zip of DICOM slices, or a NIfTI, NRRD or .tvol file')}
          choose={say('Choose file')}
          busy={sent.isPending ? phase : read.isPending ? say('Reading the files…') : null}
          onFiles={(dropped) => {
            setFiles(dropped);
            setChosen(null);
            read.mutate(dropped);
            setName(nameFrom(dropped));
            sent.reset();
          }}
        >
          {files.length === 0
            ? say(
                'Drop a CT here: a folder or a zip of DICOM slices, or a file in NIfTI (.nii, .nii.gz), NRRD or .tvol, zipped or not.',
              )
            : say('{count, plural, one {# file} other {# files}}, {size}', {
                count: counted.length,
                size: formatBytes(size),
              })}
        </DropZone>
        {several && read.data ? (
          <SeriesChoice series={read.data} chosen={chosen?.uid ?? null} onChoose={setChosen} />
        ) : null}
        {sent.isPending && gone !== null ? <Progress done={gone} of={1} label={say('Upload')} /> : null}
        {files.length > 0 ? (
          <div className={styles.form}>
            <Field
              label={say('Name, without a patient’s name')}
              value={name}
              maxLength={200}
              onChange={(event) => setName(event.target.value)}
            />
            <Field
              label={say('Origin and licence (optional)')}
              value={source}
              maxLength={400}
              onChange={(event) => setSource(event.target.value)}
            />
            <Button
              look="solid"
              disabled={name.trim() === '' || parts.length === 0 || read.isPending || sent.isPending}
              onClick={() => sent.mutate()}
            >
              {say('Upload')}
            </Button>
          </div>
        ) : null}
        {sent.isError ? (
          <Notice tone="bad" title={say('The volume was not taken.')}>
            {sent.error.message}
          </Notice>
        ) : null}
        <p className={styles.muted}>
          {say(
            'The server removes what names a patient from the file. A director or administrator then looks at the pictures and releases or refuses the volume.',
          )}
        </p>
      </div>
    </Card>
  );
}

/** CT volumes of this server. */
export function VolumesPage() {
  useTitle(say('Volumes'));
  const query = useQuery(sourceVolumesQuery);
  return (
    <div className={styles.page}>
      <div>
        <h1>{say('Volumes')}</h1>
        <p className={styles.lead}>
          {say('CT volumes from which cases are made. A volume is used after its release.')}
        </p>
      </div>
      {query.isError ? (
        <Notice tone="bad" title={say('The volumes could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card title={say('Volumes')}>
        <DataTable<SourceVolume>
          address=""
          caption={say('Volumes')}
          minWidth={640}
          rows={query.data?.volumes}
          keyOf={({ id }) => id}
          empty={say('No volumes yet. Upload the first below.')}
          filter={{ label: say('Filter by name or source'), text: (one) => `${one.name} ${one.source}` }}
          columns={[
            {
              name: marked('Volume'),
              by: ({ name }) => name,
              cell: ({ id, name }) => <Link href={`/volumes/${id}`}>{name}</Link>,
            },
            {
              name: marked('State'),
              by: ({ state }) => state,
              cell: ({ state }) => <Badge tone={kTones[state]}>{say(kStates[state])}</Badge>,
            },
            { name: marked('Source'), by: ({ source }) => source, cell: ({ source }) => source },
            { name: marked('Voxels'), cell: ({ dims }) => dims.map(formatCount).join(' × '), number: true },
            {
              name: marked('Uploaded'),
              by: ({ made_utc_us }) => made_utc_us,
              cell: ({ made_utc_us, made_by }) =>
                say('{date} by {name}', { date: formatDateTime(made_utc_us), name: made_by }),
            },
          ]}
        />
      </Card>
      <Upload />
      <FromPacs />
    </div>
  );
}
