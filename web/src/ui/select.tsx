import { useId, type ReactNode, type SelectHTMLAttributes } from 'react';
import styles from './field.module.css';

interface Props extends SelectHTMLAttributes<HTMLSelectElement> {
  readonly label: ReactNode;
  readonly options: readonly { readonly value: string; readonly text: string }[];
}

export function Select({ label, options, ...rest }: Props) {
  const id = useId();
  return (
    <div className={styles.field}>
      <label htmlFor={id}>{label}</label>
      <select id={id} {...rest}>
        {options.map(({ value, text }) => (
          <option key={value} value={value}>
            {text}
          </option>
        ))}
      </select>
    </div>
  );
}
