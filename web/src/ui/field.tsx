import { useId, type InputHTMLAttributes, type ReactNode, type Ref } from 'react';
import styles from './field.module.css';

interface Props extends InputHTMLAttributes<HTMLInputElement> {
  readonly label: ReactNode;
  /** What is wrong with the value; shown below the input. */
  readonly error?: string;
  readonly inputRef?: Ref<HTMLInputElement>;
}

export function Field({ label, error = '', inputRef, ...rest }: Props) {
  const id = useId();
  return (
    <div className={styles.field}>
      <label htmlFor={id}>{label}</label>
      <input
        id={id}
        ref={inputRef}
        {...rest}
        {...(error === '' ? {} : { 'aria-invalid': true, 'aria-describedby': `${id}-error` })}
      />
      {error === '' ? null : (
        <p id={`${id}-error`} className={styles.error} role="status">
          {error}
        </p>
      )}
    </div>
  );
}
