import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import type { MeasurementSet } from '@/api';
import { say } from '@/language';
import { Button, Notice, Select, Skeleton } from '@/ui';
import { openRecording, type Clock } from './mcap';
import { ProbingForm } from './probing-form';
import styles from './recording.module.css';
import { RoomForm } from './room-form';

interface Props {
  readonly file: File;
  readonly onAdded: (set: MeasurementSet) => void;
  readonly onClose: () => void;
}

/** A dropped MCAP recording: what is in it, and what the lab is to have of it. */
export default function RecordingForm({ file, onAdded, onClose }: Props) {
  const recording = useQuery({
    queryKey: ['recording', file.name, file.size, file.lastModified],
    queryFn: () => openRecording(file),
    retry: false,
    gcTime: 0,
    staleTime: Infinity,
  });
  const [rig, setRig] = useState('probing');
  const [wish, setClock] = useState<Clock | null>(null);
  const topics = recording.data?.topics ?? [];
  const clock: Clock = wish ?? (topics.some(({ stamped }) => stamped) ? 'header' : 'log');
  const unread = topics.filter((topic) => topic.unread !== null);
  if (recording.isError)
    return (
      <Notice tone="bad" title={say('The recording was not opened.')}>
        {recording.error.message}
      </Notice>
    );
  if (!recording.data) return <Skeleton height="120px" />;
  return (
    <section className={styles.form} aria-label={say('Recording {name}', { name: file.name })}>
      <h3>{say('Recording {name}', { name: file.name })}</h3>
      {unread.map(({ channel, name, unread: why }) => (
        <p key={channel} className={styles.unread}>
          {say('Not shown: {topic} ({why})', { topic: name, why: why ?? '' })}
        </p>
      ))}
      <div className={styles.row}>
        <Select
          label={say('What was recorded')}
          value={rig}
          options={[
            { value: 'probing', text: say('A probing rig: depth and force') },
            { value: 'room', text: say('A measuring room: poses and force') },
          ]}
          onChange={(event) => setRig(event.target.value)}
        />
        <Select
          label={say('Time')}
          value={clock}
          options={[
            { value: 'header', text: say('stamps in the messages (the senders’ clocks)') },
            { value: 'log', text: say('times of arrival (the recorder’s clock)') },
          ]}
          onChange={(event) => setClock(event.target.value === 'log' ? 'log' : 'header')}
        />
      </div>
      {rig === 'probing' ? (
        <ProbingForm recording={recording.data} clock={clock} onAdded={onAdded} />
      ) : (
        <RoomForm recording={recording.data} clock={clock} />
      )}
      <div>
        <Button onClick={onClose}>{say('Close the recording')}</Button>
      </div>
    </section>
  );
}
