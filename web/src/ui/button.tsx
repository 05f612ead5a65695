import type { ButtonHTMLAttributes } from 'react';
import styles from './button.module.css';

interface Props extends ButtonHTMLAttributes<HTMLButtonElement> {
  readonly look?: 'solid' | 'plain' | 'quiet';
  /** What a screen reader says where the button shows only a sign. */
  readonly label?: string;
  readonly pressed?: boolean;
}

export function Button({ look = 'plain', label, pressed, className, type = 'button', ...rest }: Props) {
  return (
    <button
      type={type}
      className={[styles.button, styles[look], className].filter(Boolean).join(' ')}
      aria-pressed={pressed}
      {...(label === undefined ? {} : { 'aria-label': label, title: label })}
      {...rest}
    />
  );
}
