import { useState } from 'react';
import { say } from '@/language';
import { AskDialog } from './ask-dialog';
import { Button } from './button';
import { Field } from './field';
import styles from './list-table.module.css';

export interface SavedViews {
  readonly views: readonly { readonly id: string; readonly name: string; readonly search: string }[];
  readonly save: (name: string, search: string) => Promise<unknown>;
  readonly remove: (id: string) => Promise<unknown>;
}

interface Props extends SavedViews {
  /** What is shown now, as the search part of an address. */
  readonly here: string;
  readonly onOpen: (search: string) => void;
}

/** Views of a list by the names that a person gave them: opened, saved, removed. */
export function SavedViewsBar({ views, save, remove, here, onOpen }: Props) {
  const [name, setName] = useState<string | null>(null);
  const [removing, setRemoving] = useState<SavedViews['views'][number] | null>(null);
  return (
    <div className={styles.views} role="group" aria-label={say('Saved views')}>
      {views.map((view) => (
        <span key={view.id} className={styles.view}>
          <Button pressed={view.search === here} onClick={() => onOpen(view.search)}>
            {view.name}
          </Button>
          <Button
            look="quiet"
            label={say('Remove the view {name}', { name: view.name })}
            onClick={() => setRemoving(view)}
          >
            ×
          </Button>
        </span>
      ))}
      <Button look="quiet" disabled={here === ''} onClick={() => setName('')}>
        {say('Save this view…')}
      </Button>
      {name === null ? null : (
        <AskDialog
          title={say('Save this view')}
          action={say('Save')}
          ready={name.trim() !== ''}
          onAction={() => save(name.trim(), here)}
          onClose={() => setName(null)}
        >
          <p>
            {say(
              'Search, filters and order are saved under this name, for you alone. A view of the same name is replaced.',
            )}
          </p>
          <Field label={say('Name')} value={name} maxLength={40} onChange={(event) => setName(event.target.value)} />
        </AskDialog>
      )}
      {removing === null ? null : (
        <AskDialog
          title={say('Remove the view {name}?', { name: removing.name })}
          action={say('Remove')}
          onAction={() => remove(removing.id)}
          onClose={() => setRemoving(null)}
        >
          <p>{say('The rows of the list stay.')}</p>
        </AskDialog>
      )}
    </div>
  );
}
