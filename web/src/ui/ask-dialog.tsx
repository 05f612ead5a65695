import { useEffect, useId, useRef, useState, type FormEvent, type ReactNode } from 'react';
import { say } from '@/language';
import { Button } from './button';
import styles from './dialog.module.css';
import { Notice } from './notice';

interface Props {
  readonly title: string;
  readonly children: ReactNode;
  /** Label of the button. */
  readonly action: string;
  readonly ready?: boolean;
  readonly onAction: () => Promise<unknown>;
  readonly onClose: () => void;
}

/** Asks before something is done; closes when it was, and says why when it was not. */
export function AskDialog({ title, children, action, ready = true, onAction, onClose }: Props) {
  const dialog = useRef<HTMLDialogElement>(null);
  const [busy, setBusy] = useState(false);
  const [failure, setFailure] = useState<string | null>(null);
  const id = useId();
  useEffect(() => {
    dialog.current?.showModal();
  }, []);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    setBusy(true);
    onAction().then(onClose, (wrong: unknown) => {
      setFailure(wrong instanceof Error ? wrong.message : String(wrong));
      setBusy(false);
    });
  };
  return (
    <dialog ref={dialog} className={styles.dialog} aria-labelledby={id} onClose={onClose}>
      <form onSubmit={submit}>
        <h2 id={id}>{title}</h2>
        {children}
        {failure === null ? null : (
          <Notice tone="bad" title={say('The action failed.')}>
            {failure}
          </Notice>
        )}
        <div className={styles.buttons}>
          <Button onClick={onClose}>{say('Cancel')}</Button>
          <Button look="solid" type="submit" disabled={busy || !ready}>
            {action}
          </Button>
        </div>
      </form>
    </dialog>
  );
}
