import { useMutation } from '@tanstack/react-query';
import { useState } from 'react';
import { say, Sentence } from '@/language';
import { Button, Notice, Select } from '@/ui';
import { poses, roomFiles, wrenches, type Group } from './made';
import type { Clock, Recording } from './mcap';
import styles from './recording.module.css';
import { zipped } from './zipped';

function save(name: string, zip: Uint8Array<ArrayBuffer>) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([zip], { type: 'application/zip' }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

const textOf = ({ topic, prefix }: Group) => `${topic.name} ${prefix.replace(/\.$/, '')}`.trim();

/** Force and motion of the measuring room, as files for `tractus assemble`. */
export function RoomForm({ recording, clock }: { readonly recording: Recording; readonly clock: Clock }) {
  const forces = wrenches(recording.topics),
    bodies = poses(recording.topics);
  const [picked, setPicked] = useState({ wrench: 0, tool: 0, bone: -1 });
  const wrench = forces[picked.wrench],
    tool = bodies[picked.tool];
  const made = useMutation({
    mutationFn: async () => {
      if (!wrench || !tool) return;
      const files = await roomFiles(recording, { wrench, tool, bone: bodies[picked.bone] ?? null }, clock);
      save(recording.name.replace(/\.mcap$/i, '.zip'), await zipped(files));
    },
  });
  if (!wrench || !tool)
    return (
      <Notice tone="bad" title={say('The recording has no force or no pose.')}>
        {say(
          'A topic with force and torque (geometry_msgs/WrenchStamped) and one with a pose (PoseStamped, TransformStamped) are expected.',
        )}
      </Notice>
    );
  const choice = (label: string, key: keyof typeof picked, groups: readonly Group[], none: readonly string[] = []) => (
    <Select
      label={label}
      value={String(picked[key])}
      options={[
        ...none.map((text) => ({ value: '-1', text })),
        ...groups.map((group, i) => ({ value: String(i), text: textOf(group) })),
      ]}
      onChange={(event) => setPicked({ ...picked, [key]: Number(event.target.value) })}
    />
  );
  return (
    <div className={styles.form}>
      <div className={styles.row}>
        {choice(say('Force and torque'), 'wrench', forces)}
        {choice(say('Pose of the probe’s markers'), 'tool', bodies)}
        {choice(say('Pose of the vertebra’s markers'), 'bone', bodies, [say('the vertebra does not move')])}
      </div>
      <p className={styles.unread}>
        <Sentence
          text="Force and motion keep their own stamps. Complete the frames in <code>assembly.json</code>, then run <code>tractus assemble</code>: it makes the set that is dropped here."
          parts={{ code: (words) => <code>{words}</code> }}
        />
      </p>
      {made.isError ? (
        <Notice tone="bad" title={say('The files were not made.')}>
          {made.error.message}
        </Notice>
      ) : null}
      <div>
        <Button look="solid" disabled={made.isPending} onClick={() => made.mutate()}>
          {say('Download motion.csv, force.csv and assembly.json')}
        </Button>
      </div>
    </div>
  );
}
