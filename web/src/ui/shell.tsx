import type { MouseEvent, ReactNode } from 'react';
import { marked, say, type Language } from '@/language';
import { timeZone } from '@/units';
import { Button } from './button';
import { LanguageSwitch } from './language-switch';
import styles from './shell.module.css';
import { setTheme, useTheme, type Theme } from './theme';

interface Props {
  /** Right of the name: who is signed in, sign out. */
  readonly account?: ReactNode;
  readonly home: ReactNode;
  readonly onLanguage: (chosen: Language) => void;
  readonly children: ReactNode;
}

const kNext: Record<Theme, Theme> = { system: 'light', light: 'dark', dark: 'system' };
const kThemeName: Record<Theme, string> = { system: marked('As system'), light: marked('Light'), dark: marked('Dark') };
const kThemeSign: Record<Theme, string> = { system: '◐', light: '○', dark: '●' };

function toContent(event: MouseEvent): void {
  event.preventDefault();
  document.getElementById('content')?.focus();
}

/** What stands round every page. */
export function Shell({ account, home, onLanguage, children }: Props) {
  const theme = useTheme();
  return (
    <>
      <a className={styles.skip} href="#content" onClick={toContent}>
        {say('Skip to content')}
      </a>
      <header className={styles.header}>
        <div className={styles.bar}>
          {home}
          <div className={styles.account}>
            {account}
            <Button
              look="quiet"
              title={say('Theme. Next: {name}', { name: say(kThemeName[kNext[theme]]) })}
              onClick={() => setTheme(kNext[theme])}
            >
              <span aria-hidden="true">{kThemeSign[theme]}</span>
              <span className="hidden-visually">{say('Theme:')} </span>
              <span className={styles.themeName}>{say(kThemeName[theme])}</span>
            </Button>
          </div>
        </div>
      </header>
      <main id="content" tabIndex={-1} className={styles.main}>
        {children}
      </main>
      <footer className={styles.footer}>
        <span>{say('Times are in {zone}.', { zone: timeZone() })}</span>
        <LanguageSwitch onChoose={onLanguage} />
      </footer>
    </>
  );
}
