import { useRef, useState, type KeyboardEvent } from 'react';
import type { Account, AccountChanges } from '@/api';
import { say } from '@/language';
import { AskDialog, Field } from '@/ui';
import { formatCount } from '@/units';
import styles from './class.module.css';

/** A field for each person: a badge scanner types the number and Enter, which leads to the next one. */
export function Badges({
  accounts,
  onSave,
  onClose,
}: {
  readonly accounts: readonly Account[];
  readonly onSave: (accounts: AccountChanges['accounts']) => Promise<unknown>;
  readonly onClose: () => void;
}) {
  const [badges, setBadges] = useState<Readonly<Record<string, string>>>({});
  const fields = useRef(new Map<string, HTMLInputElement>());
  const typed = accounts.filter(({ id }) => (badges[id] ?? '').trim() !== '');
  const twice = (id: string) => typed.some((one) => one.id !== id && badges[one.id]?.trim() === badges[id]?.trim());
  const onKey = (event: KeyboardEvent, place: number) => {
    if (event.key !== 'Enter') return;
    event.preventDefault();
    const next = accounts[place + 1];
    if (next) fields.current.get(next.id)?.focus();
  };
  return (
    <AskDialog
      title={say('Assign badges')}
      action={say('Save {count}', { count: formatCount(typed.length) })}
      ready={typed.length > 0 && !typed.some(({ id }) => twice(id))}
      onAction={() => onSave(typed.map(({ id }) => ({ id, badge: badges[id]?.trim() ?? '' })))}
      onClose={onClose}
    >
      <p>{say('Scan the badges one after the other. An empty field leaves the badge as it is.')}</p>
      <div className={styles.badges}>
        {accounts.map(({ id, name, badge }, place) => (
          <Field
            key={id}
            label={name}
            value={badges[id] ?? ''}
            maxLength={64}
            autoComplete="off"
            placeholder={badge ?? ''}
            inputRef={(element: HTMLInputElement | null) => {
              if (element) fields.current.set(id, element);
              else fields.current.delete(id);
            }}
            error={(badges[id] ?? '') !== '' && twice(id) ? say('Another person has this badge.') : ''}
            onKeyDown={(event) => onKey(event, place)}
            onChange={(event) => setBadges({ ...badges, [id]: event.target.value })}
          />
        ))}
      </div>
    </AskDialog>
  );
}
