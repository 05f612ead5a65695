import { useEffect, useRef } from 'react';
import { chooseLanguage, kLanguageNames, kLanguages, say, useLanguage, type Language } from '@/language';
import { Button } from './button';
import styles from './language-switch.module.css';

/** A choice made with this switch: the page is drawn anew, and the focus stays where the person had it. */
let pressed: Language | undefined;
const remember = (one: Language | undefined) => {
  pressed = one;
};

interface Props {
  /** Without: the choice is of this browser. */
  readonly onChoose?: (chosen: Language) => void;
}

/** Each language by its own name, so that whoever reads only one finds it. */
export function LanguageSwitch({ onChoose = (one) => void chooseLanguage(one) }: Props) {
  const spoken = useLanguage();
  const group = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (pressed !== spoken) return;
    remember(undefined);
    group.current?.querySelector<HTMLElement>('[aria-pressed="true"]')?.focus();
  }, [spoken]);
  const choose = (one: Language) => {
    remember(one);
    onChoose(one);
  };
  return (
    <div ref={group} className={styles.languages} role="group" aria-label={say('Language')}>
      {kLanguages.map((one) => (
        <Button key={one} look="quiet" lang={one} pressed={one === spoken} onClick={() => choose(one)}>
          {kLanguageNames[one]}
        </Button>
      ))}
    </div>
  );
}
