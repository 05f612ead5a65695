import { useEffect, useId, useRef, useState, type FormEvent } from 'react';
import { say } from '@/language';
import { Button } from './button';
import styles from './dialog.module.css';
import { Notice } from './notice';

interface Props {
  readonly title: string;
  /** What will happen, in a sentence or two. */
  readonly text: string;
  /** Label of the button. */
  readonly action: string;
  readonly reasonNeeded?: boolean;
  /** Does it; the dialog closes when that has succeeded, and says why when it has not. */
  readonly onAction: (reason: string) => Promise<void>;
  readonly onClose: () => void;
}

/** Asks before something is done that is kept, with a reason for those who read it later. Escape leaves things as they are. */
export function ReasonDialog({ title, text, action, reasonNeeded = false, onAction, onClose }: Props) {
  const dialog = useRef<HTMLDialogElement>(null);
  const [reason, setReason] = useState('');
  const [failure, setFailure] = useState<string | null>(null);
  const [busy, setBusy] = useState(false);
  const titleId = useId(),
    reasonId = useId();
  useEffect(() => {
    dialog.current?.showModal();
  }, []);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    setBusy(true);
    onAction(reason.trim()).then(onClose, (wrong: unknown) => {
      setFailure(wrong instanceof Error ? wrong.message : String(wrong));
      setBusy(false);
    });
  };
  return (
    <dialog ref={dialog} className={styles.dialog} aria-labelledby={titleId} onClose={onClose}>
      <form onSubmit={submit}>
        <h2 id={titleId}>{title}</h2>
        <p>{text}</p>
        <div className={styles.reason}>
          <label htmlFor={reasonId}>{reasonNeeded ? say('Reason') : say('Reason (optional)')}</label>
          <textarea
            id={reasonId}
            rows={3}
            maxLength={500}
            required={reasonNeeded}
            value={reason}
            onChange={(event) => setReason(event.target.value)}
          />
        </div>
        {failure === null ? null : (
          <Notice tone="bad" title={say('The action failed.')}>
            {failure}
          </Notice>
        )}
        <div className={styles.buttons}>
          <Button onClick={onClose}>{say('Cancel')}</Button>
          <Button look="solid" type="submit" disabled={busy || (reasonNeeded && reason.trim() === '')}>
            {action}
          </Button>
        </div>
      </form>
    </dialog>
  );
}
